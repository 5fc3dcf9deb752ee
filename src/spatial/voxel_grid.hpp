#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "igsp/point_cloud.hpp"
#include "spatial/cell_hash.hpp"

namespace igsp {

/// Voxel filter fed in chunks: one centroid per occupied voxel. Memory grows with the voxels, not with the points.
class VoxelFilter {
 public:
  /// Points may lie at most this many voxels away from the origin along an axis.
  static constexpr double reach = cell_reach;

  /// Voxel boundaries pass through `origin`. Throws InvalidArgument unless voxel_size is positive and finite.
  VoxelFilter(const Eigen::Vector3d& origin, double voxel_size);

  /// Throws InvalidArgument for a point beyond `reach`.
  void add(PointView chunk);

  std::size_t size() const { return voxels_.size(); }

  /// Centroids relative to the origin, sorted by voxel (z, y, x). Bit for bit independent of the order of the points:
  /// within a voxel they are summed up as integers, whose sum has no rounding.
  Points centroids() const;

 private:
  struct Voxel {
    std::uint64_t key;
    std::array<std::uint64_t, 3> sum;  // from the voxel's corner, in steps of 2^-42 voxels; its lower 64 bits
    std::uint32_t count;
    std::uint32_t carries;  // what the sums hold beyond that, 10 bits an axis: enough for 2^32 points
  };
  static void add(const Eigen::Vector3d& from_corner, Voxel& voxel);
  Eigen::Vector3d centroid(const Voxel& voxel) const;
  std::size_t slot_of(std::uint64_t key) const;
  void grow();

  Eigen::Vector3d origin_;
  double voxel_size_;
  std::vector<Voxel> voxels_;         // in order of appearance
  std::vector<std::uint32_t> table_;  // open addressing: 1 + index into voxels_, 0 = free
};

/// The whole filter in one call.
Points voxel_centroids(PointView points, const Eigen::Vector3d& origin, double voxel_size);
Points voxel_centroids(const ChunkSource& chunks, const Eigen::Vector3d& origin, double voxel_size);

}  // namespace igsp
