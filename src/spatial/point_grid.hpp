#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp {

/// Points sorted into cubic cells, rows of cells along x contiguous in memory, coordinates as separate float arrays.
/// Made for the many spheres of one or two radii that keypoints and descriptors need: a sphere is a few dozen
/// contiguous runs, which compilers vectorise over. Points must be local (centred) coordinates.
class PointGrid {
 public:
  PointGrid(PointView points, double cell_size);

  std::size_t size() const { return index.size(); }
  std::array<int, 3> cell_of(const Eigen::Vector3f& point) const {
    std::array<int, 3> cell;
    for (int axis = 0; axis < 3; ++axis) {
      const float c = (point[axis] - origin[axis]) * inverse_cell_size;
      // Truncated. In this order of arguments NaN, as from infinite coordinates, becomes 0.
      cell[axis] = static_cast<int>(std::min(std::max(0.0f, c), static_cast<float>(cells[axis] - 1)));
    }
    return cell;
  }
  std::size_t cell_number(int cx, int cy, int cz) const {
    return (static_cast<std::size_t>(cz) * cells[1] + cy) * cells[0] + cx;
  }

  /// visit(begin, end) for every run of sorted points that may lie in the box centre +- radius.
  template <typename Visit>
  void visit_runs(const Eigen::Vector3f& centre, float radius, const Visit& visit) const {
    const float limit = radius * radius;
    visit_runs(centre, radius, limit, visit);
  }

  /// The same, but for runs whose squared distance is above the limit, which `visit` may lower.
  template <typename Visit>
  void visit_runs(const Eigen::Vector3f& centre, float radius, const float& squared_limit, const Visit& visit) const {
    const auto lo = cell_of(centre - Eigen::Vector3f::Constant(radius));
    const auto hi = cell_of(centre + Eigen::Vector3f::Constant(radius));
    for (int cz = lo[2]; cz <= hi[2]; ++cz) {
      const float dz = distance_to_cell(centre.z() - origin.z(), cz);
      for (int cy = lo[1]; cy <= hi[1]; ++cy) {
        const float dy = distance_to_cell(centre.y() - origin.y(), cy);
        if (dz * dz + dy * dy > squared_limit) continue;
        const std::uint32_t begin = start[cell_number(lo[0], cy, cz)];
        const std::uint32_t end = start[cell_number(hi[0], cy, cz) + 1];
        if (begin != end) visit(begin, end);
      }
    }
  }

  /// visit(position in the sorted arrays, squared distance) for every point within `radius` of `centre`.
  template <typename Visit>
  void visit_sphere(const Eigen::Vector3f& centre, float radius, const Visit& visit) const {
    const float limit = radius * radius;
    visit_runs(centre, radius, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) {
        const float dx = x[i] - centre.x(), dy = y[i] - centre.y(), dz = z[i] - centre.z();
        const float squared = dx * dx + dy * dy + dz * dz;
        if (squared <= limit) visit(i, squared);
      }
    });
  }

  /// Nearest point within `radius`: its index in the original order, or -1.
  std::int64_t nearest(const Eigen::Vector3f& centre, float radius) const;
  /// The same, where the radius is known to be little more than the distance.
  std::int64_t nearest_within(const Eigen::Vector3f& centre, float radius) const;

  Eigen::Vector3f origin;  ///< corner of cell (0, 0, 0)
  float cell_size;
  float inverse_cell_size;
  std::array<int, 3> cells;
  std::vector<std::uint32_t> start;  ///< first sorted position of every cell, one more at the end
  std::vector<std::uint32_t> index;  ///< original index of every sorted position
  std::vector<float> x, y, z;        ///< of every sorted position, and a few at infinity for the last vector

 private:
  float distance_to_cell(float coordinate, int cell) const {
    const float low = cell * cell_size;
    return std::max({low - coordinate, coordinate - low - cell_size, 0.0f});
  }
};

}  // namespace igsp
