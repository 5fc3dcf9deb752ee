#include "network/shared_space.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/cell_hash.hpp"

namespace igsp {
namespace {

constexpr std::size_t samples_of_a_scan = 400;
constexpr double cell_size = 3;  // [voxels]: a pose of a growing network may be a voxel or two off

double share_within(const Space& a, const Space& b, const Transformation& b_from_a) {
  if (a.samples().empty()) return 0;
  const auto held = std::ranges::count_if(a.samples(), [&](const Eigen::Vector3d& p) { return b.holds(b_from_a * p); });
  return static_cast<double>(held) / static_cast<double>(a.samples().size());
}

}  // namespace

Space::Space(const Features& features) : origin_(features.origin), cell_(cell_size * features.voxel_size) {
  const std::size_t stride = std::max<std::size_t>(1, features.points.size() / samples_of_a_scan);
  for (std::size_t i = 0; i < features.points.size(); i += stride) {
    samples_.push_back(features.points[i] + features.origin);
  }
  for (const Eigen::Vector3d& point : features.points) cells_.insert(cell_key((point / cell_).array().floor()));
}

bool Space::holds(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d local = (point - origin_) / cell_;
  if (!(local.cwiseAbs().maxCoeff() < cell_reach - 1)) return false;
  return cells_.contains(cell_key(local.array().floor()));
}

double shared_space(const Space& a, const Transformation& world_from_a, const Space& b,
                    const Transformation& world_from_b) {
  const Transformation b_from_a = world_from_b.inverse() * world_from_a;
  return std::min(share_within(a, b, b_from_a), share_within(b, a, b_from_a.inverse()));
}

}  // namespace igsp
