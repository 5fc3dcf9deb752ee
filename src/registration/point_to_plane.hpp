#pragma once

#include <span>

#include "registration/prepared_cloud.hpp"

namespace igsp {

struct PointToPlaneOptions {
  std::size_t max_points = 4000;    ///< of the source, evenly strided
  std::span<const double> radii;    ///< one Gauss-Newton step each: search radius [voxels]
  int degrees_of_freedom = 6;
};

/// Fine registration: every step pairs source points with their nearest target point within the radius whose normal
/// agrees, and minimises the distances to its tangent plane under the Geman-McClure loss at half the radius. Ends early
/// where a step finds too few pairs or a free direction. Returns target_from_source.
Transformation refine_point_to_plane(const PreparedCloud& source, const PreparedCloud& target,
                                     const Transformation& initial, const PointToPlaneOptions& options);

}  // namespace igsp
