#pragma once

#include <optional>
#include <span>

#include "igsp/point_cloud.hpp"

namespace igsp {

/// A point of the source and the point of the target it is believed to be.
struct PointPair {
  Eigen::Vector3d source;
  Eigen::Vector3d target;
  double weight = 1.0;  ///< >= 0
};

/// The rigid transformation that minimises sum weight |target - T source|^2 (Eq. 9, with the sign of t set right), by
/// singular value decomposition with det R = +1. Empty when the pairs do not determine one: fewer than 3 of positive
/// weight, or all on a line.
std::optional<Transformation> rigid_fit(std::span<const PointPair> pairs);

/// The same with yaw (about z) and translation only, for levelled scans. Empty for fewer than 2 pairs or coincident in
/// xy.
std::optional<Transformation> levelled_rigid_fit(std::span<const PointPair> pairs);

/// Chooses between the two by degrees of freedom (6 or 4).
std::optional<Transformation> rigid_fit(std::span<const PointPair> pairs, int degrees_of_freedom);

}  // namespace igsp
