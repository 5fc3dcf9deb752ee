#include "spatial/scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "igsp/errors.hpp"
#include "spatial/cell_hash.hpp"
#include "spatial/scatter_filter.hpp"

namespace igsp {
namespace {

constexpr double max_voxels_per_point = 0.6;   // above it the voxels would only repeat the raw sampling
constexpr int max_steps = 16;                  // dense clouds need 3 to 5, those limited by their spacing up to 12
constexpr double max_magnitude = 1e150;        // squares of lengths stay within double precision
constexpr double max_voxels_across = 1 << 18;  // a quarter of what the voxel filter holds: few places ask for more

// Number of occupied voxels, without those of scattered noise, by linear counting (Whang et al. 1990): n = -M ln(share
// of empty slots in a map of M).
double count_voxels(PointView cloud, const Bounds& bounds, double noise_density, double voxel_size) {
  constexpr std::size_t slots = std::size_t{1} << 18;
  std::vector<std::uint64_t> map(slots / 64, 0);
  const double inverse = 1.0 / voxel_size;
  const ScatterFilter filter(cloud, bounds, noise_density, scatter_cell * voxel_size);
  for (const Eigen::Vector3d& point : cloud) {
    if (!filter.keeps(point)) continue;
    const std::size_t slot = cell_hash((point - bounds.min) * inverse) >> 46;
    map[slot / 64] |= std::uint64_t{1} << (slot % 64);
  }
  std::size_t occupied = 0;
  for (const std::uint64_t word : map) occupied += std::popcount(word);
  const double empty = std::max<double>(1.0, static_cast<double>(slots - occupied));
  return std::max(1.0, -static_cast<double>(slots) * std::log(empty / slots));
}

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

double choose_voxel_size(PointView source, PointView target, const ScaleOptions& options) {
  if (options.voxel_size > 0) return options.voxel_size;
  const Bounds source_bounds = bounds_of(source, "source");
  const Bounds target_bounds = bounds_of(target, "target");
  const double extent = std::max(source_bounds.diagonal(), target_bounds.diagonal());
  if (extent == 0) throw InvalidArgument("all points coincide in both clouds; set voxel_size to align them");

  const double source_noise = scatter_density(source, source_bounds);
  const double target_noise = scatter_density(target, target_bounds);
  double voxel_size = extent / 200;
  for (int step = 0; step < max_steps; ++step) {
    const double n_source = count_voxels(source, source_bounds, source_noise, voxel_size);
    const double n_target = count_voxels(target, target_bounds, target_noise, voxel_size);
    // A surface has about 1/v^2 voxels, hence the square root.
    const double to_count = std::sqrt(std::sqrt(n_source * n_target) / options.target_points);
    const double to_spacing = std::sqrt(
        std::max(n_source / (max_voxels_per_point * source.size()), n_target / (max_voxels_per_point * target.size())));
    const double factor = std::max(to_count, to_spacing);
    voxel_size = std::max(factor * voxel_size, extent / max_voxels_across);
    if (std::abs(factor - 1) < 0.01) break;
  }
  return voxel_size;
}

}  // namespace igsp
