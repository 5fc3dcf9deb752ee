#include "spatial/voxel_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "igsp/errors.hpp"

namespace igsp {
namespace {

// As fine as the coordinates themselves are in a cloud 2000 voxels across.
constexpr double steps_per_voxel = 0x1p42;
constexpr int carry_bits = 10;

std::uint64_t scatter(std::uint64_t key) {
  key *= 0x9E3779B97F4A7C15ull;  // Fibonacci hashing: the golden ratio spreads neighbouring cells
  return key ^ (key >> 32);
}

}  // namespace

VoxelFilter::VoxelFilter(const Eigen::Vector3d& origin, double voxel_size)
    : origin_(origin), voxel_size_(voxel_size), table_(1 << 12, 0) {
  if (!(voxel_size > 0) || !std::isfinite(voxel_size)) {
    throw InvalidArgument(fmt::format("voxel_size is {}; it must be positive and finite", voxel_size));
  }
}

std::size_t VoxelFilter::slot_of(std::uint64_t key) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = scatter(key) & mask;
  while (table_[slot] != 0 && voxels_[table_[slot] - 1].key != key) slot = (slot + 1) & mask;
  return slot;
}

void VoxelFilter::grow() {
  table_.assign(2 * table_.size(), 0);
  for (std::size_t i = 0; i < voxels_.size(); ++i) {
    table_[slot_of(voxels_[i].key)] = static_cast<std::uint32_t>(i + 1);
  }
}

void VoxelFilter::add(PointView chunk) {
  const double inverse = 1.0 / voxel_size_;
  for (const Eigen::Vector3d& point : chunk) {
    const Eigen::Vector3d local = point - origin_;
    const Eigen::Vector3d place = local * inverse;
    const Eigen::Vector3d cell = place.array().floor();
    if (!(cell.array().abs().maxCoeff() < cell_reach)) {
      throw InvalidArgument(
          fmt::format("voxel_size is {}: too small for a cloud of this extent (a point lies {} away from the origin of "
                      "the grid; at most 2^20 voxels are possible)",
                      voxel_size_, local.norm()));
    }
    const std::uint64_t key = cell_key(cell);
    const std::size_t slot = slot_of(key);
    if (table_[slot] != 0) {
      add(place - cell, voxels_[table_[slot] - 1]);
    } else {
      voxels_.push_back({key, {}, 0, 0});
      add(place - cell, voxels_.back());
      table_[slot] = static_cast<std::uint32_t>(voxels_.size());
      if (2 * voxels_.size() > table_.size()) grow();
    }
  }
}

void VoxelFilter::add(const Eigen::Vector3d& from_corner, Voxel& voxel) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto steps = static_cast<std::uint64_t>(from_corner[axis] * steps_per_voxel + 0.5);
    voxel.sum[axis] += steps;
    if (voxel.sum[axis] < steps) voxel.carries += 1u << (carry_bits * axis);
  }
  ++voxel.count;
}

Eigen::Vector3d VoxelFilter::centroid(const Voxel& voxel) const {
  Eigen::Vector3d from_corner;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t carry = voxel.carries >> (carry_bits * axis) & ((1u << carry_bits) - 1);
    from_corner[axis] = (carry * 0x1p64 + static_cast<double>(voxel.sum[axis])) / (steps_per_voxel * voxel.count);
  }
  return (cell_of(voxel.key) + from_corner) * voxel_size_;
}

Points VoxelFilter::centroids() const {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(voxels_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = {voxels_[i].key, static_cast<std::uint32_t>(i)};
  std::sort(order.begin(), order.end());
  Points centroids(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) centroids[i] = centroid(voxels_[order[i].second]);
  return centroids;
}

Points voxel_centroids(PointView points, const Eigen::Vector3d& origin, double voxel_size) {
  VoxelFilter filter(origin, voxel_size);
  filter.add(points);
  return filter.centroids();
}

Points voxel_centroids(const ChunkSource& chunks, const Eigen::Vector3d& origin, double voxel_size) {
  VoxelFilter filter(origin, voxel_size);
  for (PointView chunk = chunks(); !chunk.empty(); chunk = chunks()) filter.add(chunk);
  return filter.centroids();
}

}  // namespace igsp
