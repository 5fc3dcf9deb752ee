#pragma once

#include <functional>
#include <vector>

#include "spatial/point_grid.hpp"

namespace igsp {

/// Principal component analysis of every point's sphere (the point itself included), in the order of the input points.
struct LocalPca {
  std::vector<float> curvature;           ///< surface variation l3 / (l1 + l2 + l3), 0 where the sum is 0
  std::vector<float> ratio21;             ///< l2 / l1, 0 where l1 is 0
  std::vector<float> ratio32;             ///< l3 / l2, 0 where l2 is 0
  std::vector<std::uint32_t> neighbours;  ///< points in the sphere
  std::vector<Eigen::Vector3f> normals;   ///< eigenvector of l3, unit, sign arbitrary
};

/// Cost is shared among the points of a cell, so `grid` should have cells of about half the radius.
/// `tick(share done)` is called now and then on the calling thread and may throw.
LocalPca local_pca(const PointGrid& grid, double radius, int threads, const std::function<void(double)>& tick = {});

/// Normal of one place from the points within `radius` of it: eigenvector of l3, unit, sign arbitrary. Where they are too
/// few for a surface, or lie along a line, from those within 2, 4 or 8 times the radius.
Eigen::Vector3d local_normal(const PointGrid& grid, const Eigen::Vector3f& place, double radius);

}  // namespace igsp
