#include "spatial/unit_of_length.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "igsp/errors.hpp"

namespace igsp {
namespace {

// Squares of lengths stay well inside single precision, and the normal equations, which mix rotations without a unit
// with translations, well conditioned.
constexpr int ordinary_exponent = 10;
constexpr double voxels_across = 256;  // about what is chosen
constexpr double most_voxels_across = 1 << 20;
constexpr double least_reference = 1e-160;  // its inverse is finite
constexpr double least_step = 0x1p-80;      // of the coordinates: two that differ, differ by more

double magnitude_of(const Bounds& bounds) {
  return std::max(bounds.min.cwiseAbs().maxCoeff(), bounds.max.cwiseAbs().maxCoeff());
}

}  // namespace

double unit_of_length(const Bounds& source, const Bounds& target, double voxel_size) {
  const double side = std::max((source.max - source.min).maxCoeff(), (target.max - target.min).maxCoeff());
  const double expected = voxel_size > 0 ? voxel_size : side / voxels_across;
  const double reference = std::max(
      {expected, side / most_voxels_across, least_step * std::max(magnitude_of(source), magnitude_of(target))});
  if (reference == 0) return 1;
  const int exponent = std::ilogb(std::max(reference, least_reference));
  if (std::abs(exponent) <= ordinary_exponent) return 1;
  if (voxel_size > 0 && !(side / voxel_size < most_voxels_across)) {
    throw InvalidArgument(fmt::format(
        "voxel_size is {}: too small for a cloud of this extent ({}; at most 2^20 voxels across are possible)",
        voxel_size, side));
  }
  return std::ldexp(1.0, exponent);
}

Points in_unit(PointView points, double unit) {
  Points scaled(points.begin(), points.end());
  for (Eigen::Vector3d& point : scaled) point /= unit;
  return scaled;
}

Eigen::Vector3d in_unit(const Eigen::Vector3d& place, double unit, std::string_view name) {
  Eigen::Vector3d scaled = place / unit;
  if (scaled.allFinite()) return scaled;
  throw InvalidArgument(
      fmt::format("{} is ({}, {}, {}): too far away for clouds of this extent", name, place.x(), place.y(), place.z()));
}

std::optional<Eigen::Vector3d> in_unit(const std::optional<Eigen::Vector3d>& viewpoint, double unit) {
  if (!viewpoint) return std::nullopt;
  return in_unit(*viewpoint, unit, "viewpoint");
}

}  // namespace igsp
