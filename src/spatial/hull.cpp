#include "spatial/hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace igsp {
namespace {

constexpr int directions = 128;
constexpr int columns = 32;  // along x and y

// Evenly over half the sphere (Fibonacci spiral).
Eigen::Vector3d direction(int i) {
  const double golden_angle = M_PI * (3 - std::sqrt(5.0));
  const double z = (i + 0.5) / directions, r = std::sqrt(1 - z * z), angle = golden_angle * i;
  return {r * std::cos(angle), r * std::sin(angle), z};
}

int column_of(double coordinate, double min, double max) {
  return max > min ? std::clamp(static_cast<int>(columns * (coordinate - min) / (max - min)), 0, columns - 1) : 0;
}

// The lowest or highest point of a column. Its height lies beside it: most points are compared with that alone.
struct Extreme {
  double z = 0;
  const Eigen::Vector3d* point = nullptr;
};

// By height; of the same height any rule serves that does not ask for the order of the points.
bool is_lower(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::array{a.z(), a.x(), a.y()} < std::array{b.z(), b.x(), b.y()};
}

// The lowest and the highest of every column: all that can lie on the hull, but for the width of a column.
Points outermost(PointView cloud, const Bounds& bounds) {
  std::vector<Extreme> lowest(columns * columns), highest = lowest;
  for (const Eigen::Vector3d& point : cloud) {
    const int column = column_of(point.x(), bounds.min.x(), bounds.max.x()) * columns +
                       column_of(point.y(), bounds.min.y(), bounds.max.y());
    Extreme &low = lowest[column], &high = highest[column];
    if (!low.point || (point.z() <= low.z && is_lower(point, *low.point))) low = {point.z(), &point};
    if (!high.point || (point.z() >= high.z && is_lower(*high.point, point))) high = {point.z(), &point};
  }
  Points points;
  for (int i = 0; i < columns * columns; ++i) {
    if (lowest[i].point) points.push_back(*lowest[i].point), points.push_back(*highest[i].point);
  }
  return points;
}

}  // namespace

Hull::Hull(PointView cloud, const Bounds& bounds) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (int i = 0; i < directions; ++i) slabs_.push_back({direction(i), infinity, -infinity});
  for (const Eigen::Vector3d& point : outermost(cloud, bounds)) {
    for (Slab& slab : slabs_) {
      const double along = slab.direction.dot(point);
      slab.min = std::min(slab.min, along);
      slab.max = std::max(slab.max, along);
    }
  }
}

bool Hull::holds(const Eigen::Vector3d& place, double margin) const {
  return std::ranges::all_of(slabs_, [&](const Slab& slab) {
    const double along = slab.direction.dot(place), inset = margin * (slab.max - slab.min);
    return slab.min + inset <= along && along <= slab.max - inset;
  });
}

}  // namespace igsp
