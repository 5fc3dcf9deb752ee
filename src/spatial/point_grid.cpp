#include "spatial/point_grid.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "core/multiversion.hpp"

namespace igsp {
namespace {

// Sparse clouds get larger cells instead of more of them: empty cells cost memory and the time to fill it.
constexpr double max_cells_per_point = 20;
constexpr double min_max_cells = 1e5;
constexpr double least_cell = 1e-9;  // of the extent

// Of so many sorted points at a time the distances are compared; generic vectors, which the compiler lowers to what the
// machine has.
constexpr int lanes = 8;
using Floats = float __attribute__((vector_size(4 * lanes)));
using Flags = std::int32_t __attribute__((vector_size(4 * lanes)));

inline __attribute__((always_inline)) void load_beside(float place, const float* values, Floats& offsets) {
  std::memcpy(&offsets, values, sizeof offsets);
  offsets -= place;
}

inline __attribute__((always_inline)) bool is_any(const Flags& flags) {
  using Words = std::int64_t __attribute__((vector_size(4 * lanes)));
  const auto words = reinterpret_cast<Words>(flags);
  return ((words[0] | words[1]) | (words[2] | words[3])) != 0;
}

// Looks at whole vectors, so at points of the next cells as well, which are candidates like any other.
IGSP_MULTIVERSION std::int64_t nearest_of(const PointGrid& grid, const Eigen::Vector3f& centre, float radius) {
  const float cx = centre.x(), cy = centre.y(), cz = centre.z();
  float best = radius * radius;
  std::int64_t nearest = -1;
  grid.visit_runs(centre, radius, best, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t first = begin; first < end; first += lanes) {
      Floats dx, dy, dz;
      load_beside(cx, &grid.x[first], dx), load_beside(cy, &grid.y[first], dy), load_beside(cz, &grid.z[first], dz);
      const Floats squared = dx * dx + dy * dy + dz * dz;
      if (!is_any(squared <= best)) continue;
      const std::size_t count = std::min<std::size_t>(lanes, grid.size() - first);
      for (std::size_t lane = 0; lane < count; ++lane) {
        // Ties go to the lower original index, so that the answer does not depend on the cells.
        const std::uint32_t i = grid.index[first + lane];
        if (squared[lane] < best || (squared[lane] == best && (nearest < 0 || i < nearest))) {
          best = squared[lane];
          nearest = i;
        }
      }
    }
  });
  return nearest;
}

}  // namespace

PointGrid::PointGrid(PointView points, double wanted_cell_size) : index(points.size()) {
  Eigen::Vector3d min = Eigen::Vector3d::Zero(), max = Eigen::Vector3d::Zero();
  if (!points.empty()) min = max = points[0];
  for (const Eigen::Vector3d& point : points) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  const Eigen::Vector3d extent = max - min;
  // Neither vanishing nor negative, whatever was asked for: the loop below ends and no division is by zero.
  double size = std::max({wanted_cell_size, least_cell * extent.maxCoeff(), std::numeric_limits<double>::min()});
  const double max_cells = std::max(min_max_cells, max_cells_per_point * static_cast<double>(points.size()));
  while (((extent / size).array().floor() + 1).prod() > max_cells) size *= 1.26;
  cell_size = static_cast<float>(size);
  inverse_cell_size = 1.0f / cell_size;
  origin = min.cast<float>();
  for (int axis = 0; axis < 3; ++axis) cells[axis] = static_cast<int>(extent[axis] / size) + 1;

  start.assign(cell_number(0, 0, cells[2]) + 1, 0);
  std::vector<std::uint32_t> cell(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto c = cell_of(points[i].cast<float>());
    cell[i] = static_cast<std::uint32_t>(cell_number(c[0], c[1], c[2]));
    ++start[cell[i] + 1];
  }
  for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];

  std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
  for (std::vector<float>* coordinates : {&x, &y, &z}) {
    coordinates->assign(points.size() + lanes - 1, std::numeric_limits<float>::infinity());
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t position = next[cell[i]]++;
    index[position] = static_cast<std::uint32_t>(i);
    x[position] = static_cast<float>(points[i].x());
    y[position] = static_cast<float>(points[i].y());
    z[position] = static_cast<float>(points[i].z());
  }
}

std::int64_t PointGrid::nearest(const Eigen::Vector3f& centre, float radius) const {
  // Most queries end close by: a small sphere first, and what it finds is the nearest of all.
  for (float reach = std::min(radius, 0.4f * cell_size); reach > 0 && reach < radius; reach *= 2.5f) {
    const std::int64_t found = nearest_within(centre, reach);
    if (found >= 0) return found;
  }
  return nearest_within(centre, radius);
}

std::int64_t PointGrid::nearest_within(const Eigen::Vector3f& centre, float radius) const {
  return nearest_of(*this, centre, radius);
}

}  // namespace igsp
