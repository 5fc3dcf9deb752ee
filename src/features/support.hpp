#pragma once

#include <cmath>
#include <vector>

#include "spatial/point_grid.hpp"

namespace igsp {

/// The points within sqrt(3) R of a keypoint, relative to it: what frames and descriptors are made of.
struct Support {
  std::vector<float> x, y, z;
  std::size_t size() const { return x.size(); }
};

inline void gather_support(const PointGrid& grid, const Eigen::Vector3d& keypoint, double descriptor_radius,
                           Support& support) {
  support.x.clear(), support.y.clear(), support.z.clear();
  const Eigen::Vector3f centre = keypoint.cast<float>();
  grid.visit_sphere(centre, static_cast<float>(std::sqrt(3.0) * descriptor_radius), [&](std::uint32_t i, float) {
    support.x.push_back(grid.x[i] - centre.x());
    support.y.push_back(grid.y[i] - centre.y());
    support.z.push_back(grid.z[i] - centre.z());
  });
}

}  // namespace igsp
