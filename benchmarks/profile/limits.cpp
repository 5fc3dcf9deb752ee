#include "profile/limits.hpp"

#include <bit>
#include <numeric>

#include "matching/hamming.hpp"
#include "spatial/bounds.hpp"
#include "spatial/local_pca.hpp"
#include "spatial/voxel_grid.hpp"

namespace igsp::profile {

namespace {

volatile double sink;  // what is stored here is not optimised away

void read_once(PointView points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  sink = sum.sum();
}

/// One exclusive or, one popcount, one addition a word.
#if defined(__x86_64__)
__attribute__((target("popcnt")))
#endif
void popcount_once(std::span<const Descriptor> sources, std::span<const Descriptor> targets) {
  std::uint64_t bits = 0;
  for (const Descriptor& source : sources) {
    for (const Descriptor& target : targets) {
      for (std::size_t word = 0; word < bsc_words; ++word) {
        bits += static_cast<std::uint64_t>(std::popcount(source[word] ^ target[word]));
      }
    }
  }
  sink = static_cast<double>(bits);
}

/// As many coordinates as there are neighbours, in the order in which they lie.
void touch_once(const PointGrid& grid, std::uint64_t neighbours) {
  float sum = 0;
  for (std::uint64_t left = neighbours; left > 0;) {
    const std::uint64_t now = std::min<std::uint64_t>(left, grid.size());
    for (std::uint64_t i = 0; i < now; ++i) sum += grid.x[i] + grid.y[i] + grid.z[i];
    left -= now;
  }
  sink = static_cast<double>(sum);
}

}  // namespace

Kernels::Kernels(const Points& source, const Points& target, const Options& options)
    : cloud_(source),
      source_(extract_features(source, options)),
      target_(extract_features(target, options)),
      pca_radius_(options.keypoints.pca_radius * source_.voxel_size),
      grid_(source_.points, 0.5 * pca_radius_) {
  for (const std::uint32_t count : local_pca(grid_, pca_radius_, 1).neighbours) neighbours_ += count;
}

std::vector<Kernel> Kernels::all() const {
  const auto filter = [this] {
    const Bounds bounds = bounds_of(cloud_, "cloud");
    sink = voxel_centroids(cloud_, bounds.min, source_.voxel_size).front().x();
  };
  const auto distances = [this] {
    sink = feature_distance_matrix(source_.descriptors, 1, target_.descriptors, 1).front();
  };
  return {{"voxel filter", cloud_.size(), filter, [this] { read_once(cloud_); }},
          {"Hamming distances", source_.descriptors.size() * target_.descriptors.size() * bsc_words, distances,
           [this] { popcount_once(source_.descriptors, target_.descriptors); }},
          {"normals", neighbours_, [this] { sink = local_pca(grid_, pca_radius_, 1).curvature.front(); },
           [this] { touch_once(grid_, neighbours_); }}};
}

std::string Kernels::vectors() const {
  return std::string(to_string(best_simd_level()));
}

}  // namespace igsp::profile
