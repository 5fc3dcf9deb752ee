#include "spatial/bounds.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "igsp/errors.hpp"

namespace igsp {
namespace {

constexpr double max_magnitude = 1e150;  // squares of lengths stay within double precision

void require_representable(const Bounds& bounds, std::string_view name) {
  const double magnitude = std::max(bounds.min.cwiseAbs().maxCoeff(), bounds.max.cwiseAbs().maxCoeff());
  if (magnitude > max_magnitude) {
    throw InvalidArgument(
        fmt::format("{}: a coordinate is {} in magnitude; at most {} is possible, so that squares of "
                    "distances stay finite",
                    name, magnitude, max_magnitude));
  }
  const double extent = (bounds.max - bounds.min).maxCoeff();
  if (extent > 0 && extent < 1 / max_magnitude) {
    throw InvalidArgument(
        fmt::format("{}: the extent is {}; at least {} is needed, so that squares of distances do "
                    "not vanish",
                    name, extent, 1 / max_magnitude));
  }
}

}  // namespace

Bounds bounds_of(PointView cloud, std::string_view name) {
  if (cloud.empty()) throw InvalidArgument(fmt::format("{} has no points; at least one is needed", name));
  Bounds bounds{cloud[0], cloud[0]};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d& point = cloud[i];
    if (!point.allFinite()) {
      throw InvalidArgument(fmt::format("{}: point {} is ({}, {}, {}); coordinates must be finite", name, i, point.x(),
                                        point.y(), point.z()));
    }
    bounds.min = bounds.min.cwiseMin(point);
    bounds.max = bounds.max.cwiseMax(point);
  }
  require_representable(bounds, name);
  return bounds;
}

Eigen::Vector3d centre_of(const Bounds& bounds) {
  return bounds.min + 0.5 * (bounds.max - bounds.min);
}

}  // namespace igsp
