#pragma once

#include <vector>

#include "spatial/bounds.hpp"

namespace igsp {

/// The convex hull of a cloud, about: between slabs of many directions, so that a rotation of the cloud changes little.
/// The order of the points does not matter.
class Hull {
 public:
  Hull(PointView cloud, const Bounds& bounds);

  /// Whether a place is inside, away from every side by `margin` of the hull's width in that direction.
  bool holds(const Eigen::Vector3d& place, double margin = 0) const;

 private:
  struct Slab {
    Eigen::Vector3d direction;
    double min, max;
  };
  std::vector<Slab> slabs_;
};

}  // namespace igsp
