#include "spatial/scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "igsp/errors.hpp"

namespace igsp {
namespace {

constexpr double max_voxels_per_point = 0.6;   // above it the voxels would only repeat the raw sampling
constexpr int max_steps = 16;                  // dense clouds need 3 to 5, those limited by their spacing up to 12
constexpr double max_voxels_across = 1 << 18;  // a quarter of what the voxel filter holds: few places ask for more

// Number of occupied voxels by linear counting (Whang et al. 1990): n = -M ln(share of empty slots in a map of M).
double count_voxels(PointView cloud, const Bounds& bounds, double voxel_size) {
  constexpr std::size_t slots = std::size_t{1} << 18;
  std::vector<std::uint64_t> map(slots / 64, 0);
  const double inverse = 1.0 / voxel_size;
  for (const Eigen::Vector3d& point : cloud) {
    const Eigen::Vector3d cell = (point - bounds.min) * inverse;
    std::uint64_t key = static_cast<std::uint64_t>(cell.x()) * 0x9E3779B97F4A7C15ull ^
                        static_cast<std::uint64_t>(cell.y()) * 0xC2B2AE3D27D4EB4Full ^
                        static_cast<std::uint64_t>(cell.z()) * 0x165667B19E3779F9ull;
    key = (key ^ (key >> 29)) * 0xBF58476D1CE4E5B9ull;
    const std::size_t slot = key >> 46;
    map[slot / 64] |= std::uint64_t{1} << (slot % 64);
  }
  std::size_t occupied = 0;
  for (const std::uint64_t word : map) occupied += std::popcount(word);
  const double empty = std::max<double>(1.0, static_cast<double>(slots - occupied));
  return std::max(1.0, -static_cast<double>(slots) * std::log(empty / slots));
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
  return bounds;
}

Eigen::Vector3d centre_of(const Bounds& bounds) { return bounds.min + 0.5 * (bounds.max - bounds.min); }

double choose_voxel_size(PointView source, PointView target, const ScaleOptions& options) {
  if (options.voxel_size > 0) return options.voxel_size;
  const Bounds source_bounds = bounds_of(source, "source");
  const Bounds target_bounds = bounds_of(target, "target");
  const double extent = std::max(source_bounds.diagonal(), target_bounds.diagonal());
  if (extent == 0) throw InvalidArgument("all points coincide in both clouds; set voxel_size to align them");

  double voxel_size = extent / 200;
  for (int step = 0; step < max_steps; ++step) {
    const double n_source = count_voxels(source, source_bounds, voxel_size);
    const double n_target = count_voxels(target, target_bounds, voxel_size);
    // A surface has about 1/v^2 voxels, hence the square root.
    const double to_count = std::sqrt(std::sqrt(n_source * n_target) / options.target_points);
    const double to_spacing = std::sqrt(std::max(n_source / (max_voxels_per_point * source.size()),
                                                 n_target / (max_voxels_per_point * target.size())));
    const double factor = std::max(to_count, to_spacing);
    voxel_size = std::max(factor * voxel_size, extent / max_voxels_across);
    if (std::abs(factor - 1) < 0.01) break;
  }
  return voxel_size;
}

}  // namespace igsp
