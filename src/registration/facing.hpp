#pragma once

#include "igsp/point_cloud.hpp"

namespace igsp {

/// A place of a surface as its cloud has it, and where that was seen from.
struct SeenPlace {
  const Eigen::Vector3d& point;
  const Eigen::Vector3d& normal;     ///< unit, sign arbitrary
  const Eigen::Vector3d* viewpoint;  ///< null: not known

  /// 1 where the normal looks at the scanner, -1 where it looks away, 0 where nobody can tell: the viewpoint is not
  /// known, or the angle so small that the normal's own error decides.
  int facing() const {
    constexpr double grazing = 0.2;  // cosine of the incidence
    if (!viewpoint) return 0;
    const Eigen::Vector3d ray = *viewpoint - point;
    const double along = normal.dot(ray);
    if (along * along < grazing * grazing * ray.squaredNorm()) return 0;
    return along > 0 ? 1 : -1;
  }
};

/// Whether two places beside each other are those of a wall that was seen from either side: near as they are, no
/// surface is common to both. `cosine`: between the normals, in one frame.
inline bool are_two_sides(const SeenPlace& a, const SeenPlace& b, double cosine) {
  constexpr double opposite = 0.5;
  return a.facing() * b.facing() * cosine < -opposite;
}

}  // namespace igsp
