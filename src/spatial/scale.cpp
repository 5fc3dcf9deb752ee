#include "spatial/scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/parallel.hpp"
#include "igsp/errors.hpp"
#include "spatial/cell_hash.hpp"
#include "spatial/scatter_filter.hpp"

namespace igsp {
namespace {

constexpr double max_voxels_per_point = 0.6;  // above it the voxels would only repeat the raw sampling
constexpr double max_lonely = 0.6;       // of the voxels hold one point: an even sampling at the limit above has 0.55
constexpr double lonely_per_step = 0.5;  // how fast their share falls with the logarithm of the voxel size, about
constexpr int max_scale_steps = 24;      // dense clouds need 3 to 5, those limited by their spacing up to 12
constexpr double max_voxels_across = 1 << 18;  // a quarter of what the voxel filter holds: few places ask for more

struct Occupancy {
  double voxels;  // number of occupied ones
  double lonely;  // share of them that hold a single point, [0, 1]
};

// Without the voxels of scattered noise; by linear counting (Whang et al. 1990): n = -M ln(share of empty slots in a
// map of M).
Occupancy occupancy(PointView cloud, const Bounds& bounds, const ScatteredNoise& noise, double voxel_size) {
  constexpr std::size_t slots = std::size_t{1} << 18;
  std::vector<std::uint8_t> map(slots, 0);  // points a slot, at most 2
  const double inverse = 1.0 / voxel_size;
  const ScatterFilter filter(cloud, bounds, noise, scatter_cell * voxel_size);
  for (const Eigen::Vector3d& point : cloud) {
    if (!filter.keeps(point)) continue;
    std::uint8_t& count = map[cell_hash((point - bounds.min) * inverse) >> 46];
    count += count < 2;
  }
  std::array<std::size_t, 3> slots_of{};
  for (const std::uint8_t count : map) ++slots_of[count];
  const auto empty = static_cast<double>(std::max<std::size_t>(1, slots_of[0]));
  const auto occupied = static_cast<double>(std::max<std::size_t>(1, slots_of[1] + slots_of[2]));
  return {std::max(1.0, -static_cast<double>(slots) * std::log(empty / slots)),
          static_cast<double>(slots_of[1]) / occupied};
}

}  // namespace

double choose_voxel_size(const TrimmedCloud& source, const TrimmedCloud& target, const ScaleOptions& options,
                         int threads) {
  if (options.voxel_size > 0) return options.voxel_size;
  const double extent = std::max(source.bounds().diagonal(), target.bounds().diagonal());
  if (extent == 0) throw InvalidArgument("all points coincide in both clouds; set voxel_size to align them");

  ScatteredNoise source_noise, target_noise;
  parallel_pair(
      threads, [&] { source_noise = scattered_noise(source.points(), source.bounds()); },
      [&] { target_noise = scattered_noise(target.points(), target.bounds()); });
  double voxel_size = extent / 200;
  for (int step = 0; step < max_scale_steps; ++step) {
    Occupancy in_source, in_target;
    parallel_pair(
        threads, [&] { in_source = occupancy(source.points(), source.bounds(), source_noise, voxel_size); },
        [&] { in_target = occupancy(target.points(), target.bounds(), target_noise, voxel_size); });
    // A surface has about 1/v^2 voxels, hence the square root.
    const double to_count = std::sqrt(std::sqrt(in_source.voxels * in_target.voxels) / options.target_points);
    const double to_spacing = std::sqrt(std::max(in_source.voxels / (max_voxels_per_point * source.points().size()),
                                                 in_target.voxels / (max_voxels_per_point * target.points().size())));
    const double lonely =
        0.5 * (in_source.lonely + in_target.lonely);  // of one alone: the other may lie in its dense part
    const double to_company = std::exp((lonely - max_lonely) / lonely_per_step);
    const double factor = std::max({to_count, to_spacing, to_company});
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
