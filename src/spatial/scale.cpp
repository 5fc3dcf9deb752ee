#include "spatial/scale.hpp"

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

}  // namespace

double choose_voxel_size(const TrimmedCloud& source, const TrimmedCloud& target, const ScaleOptions& options) {
  if (options.voxel_size > 0) return options.voxel_size;
  const double extent = std::max(source.bounds().diagonal(), target.bounds().diagonal());
  if (extent == 0) throw InvalidArgument("all points coincide in both clouds; set voxel_size to align them");

  const double source_noise = scatter_density(source.points(), source.bounds());
  const double target_noise = scatter_density(target.points(), target.bounds());
  double voxel_size = extent / 200;
  for (int step = 0; step < max_steps; ++step) {
    const double n_source = count_voxels(source.points(), source.bounds(), source_noise, voxel_size);
    const double n_target = count_voxels(target.points(), target.bounds(), target_noise, voxel_size);
    // A surface has about 1/v^2 voxels, hence the square root.
    const double to_count = std::sqrt(std::sqrt(n_source * n_target) / options.target_points);
    const double to_spacing = std::sqrt(std::max(n_source / (max_voxels_per_point * source.points().size()),
                                                 n_target / (max_voxels_per_point * target.points().size())));
    const double factor = std::max(to_count, to_spacing);
    voxel_size = std::max(factor * voxel_size, extent / max_voxels_across);
    if (std::abs(factor - 1) < 0.01) break;
  }
  return voxel_size;
}

double choose_voxel_size(PointView source, PointView target, const ScaleOptions& options) {
  if (options.voxel_size > 0) return options.voxel_size;
  return choose_voxel_size(TrimmedCloud(source, "source"), TrimmedCloud(target, "target"), options);
}

}  // namespace igsp
