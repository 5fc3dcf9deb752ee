#pragma once

#include <cmath>
#include <vector>

#include "spatial/point_grid.hpp"

namespace igsp {

/// A view of a support's coordinates.
struct SupportView {
  const float *x, *y, *z;
  std::size_t size;
};

/// The points within sqrt(3) R of a keypoint, relative to it: what frames and descriptors are made of.
struct Support {
  std::vector<float> x, y, z;
  std::size_t size() const { return x.size(); }
  operator SupportView() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

inline void gather_support(const PointGrid& grid, const Eigen::Vector3d& keypoint, double descriptor_radius,
                           Support& support) {
  const Eigen::Vector3f centre = keypoint.cast<float>();
  const float radius = static_cast<float>(std::sqrt(3.0) * descriptor_radius);
  std::size_t size = 0;
  grid.visit_runs(centre, radius, [&](std::uint32_t begin, std::uint32_t end) {
    const std::size_t needed = size + (end - begin);
    if (support.x.size() < needed) {
      support.x.resize(2 * needed), support.y.resize(2 * needed), support.z.resize(2 * needed);
    }
    float *x = support.x.data(), *y = support.y.data(), *z = support.z.data();
    for (std::uint32_t i = begin; i < end; ++i) {
      const float dx = grid.x[i] - centre.x(), dy = grid.y[i] - centre.y(), dz = grid.z[i] - centre.z();
      x[size] = dx, y[size] = dy, z[size] = dz;
      size += dx * dx + dy * dy + dz * dz <= radius * radius;  // no branch: it would be unpredictable
    }
  });
  support.x.resize(size), support.y.resize(size), support.z.resize(size);
}

/// The supports of many keypoints, kept because they are described again in every common frame.
struct SupportTable {
  Support all;                        ///< one after the other
  std::vector<std::size_t> begin{0};  ///< of every support, and the end
  std::size_t size() const { return begin.size() - 1; }
  SupportView operator[](std::size_t i) const {
    return {all.x.data() + begin[i], all.y.data() + begin[i], all.z.data() + begin[i], begin[i + 1] - begin[i]};
  }
};

inline SupportTable gather_supports(const PointGrid& grid, PointView keypoints, double descriptor_radius) {
  SupportTable table;
  Support support;
  for (const Eigen::Vector3d& keypoint : keypoints) {
    gather_support(grid, keypoint, descriptor_radius, support);
    table.all.x.insert(table.all.x.end(), support.x.begin(), support.x.end());
    table.all.y.insert(table.all.y.end(), support.y.begin(), support.y.end());
    table.all.z.insert(table.all.z.end(), support.z.begin(), support.z.end());
    table.begin.push_back(table.all.size());
  }
  return table;
}

}  // namespace igsp
