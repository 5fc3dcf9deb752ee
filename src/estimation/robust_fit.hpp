#pragma once

#include <optional>
#include <span>

#include "estimation/rigid_fit.hpp"

namespace igsp {

/// Weight of a residual under the Geman-McClure loss, 1 at 0; 0 beyond three scales, where nothing is left to say.
inline double geman_mcclure_weight(double squared_residual, double squared_scale) {
  if (squared_residual > 9.0 * squared_scale) return 0.0;
  const double root = squared_scale / (squared_scale + squared_residual);
  return root * root;
}

/// Rigid fit that outliers do not bend: iteratively reweighted least squares with the Geman-McClure loss, one pass per
/// entry of `scales` (coarse to fine, units of the cloud), from `initial`. Empty when a pass leaves too few pairs.
std::optional<Transformation> robust_fit(std::span<const PointPair> pairs, const Transformation& initial,
                                         std::span<const double> scales, int degrees_of_freedom);

/// Pairs whose residual under the transformation is below `tolerance`.
std::size_t count_inliers(std::span<const PointPair> pairs, const Transformation& transformation, double tolerance);

}  // namespace igsp
