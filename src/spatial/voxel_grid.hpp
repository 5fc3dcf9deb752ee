#pragma once

#include <cstdint>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp {

/// Voxel filter fed in chunks: one centroid per occupied voxel. Memory grows with the voxels, not with the points.
class VoxelFilter {
 public:
  /// Voxel boundaries pass through `origin`. Throws InvalidArgument unless voxel_size is positive and finite.
  VoxelFilter(const Eigen::Vector3d& origin, double voxel_size);

  /// Throws InvalidArgument for a point more than 2^20 voxels away from the origin.
  void add(PointView chunk);

  std::size_t size() const { return voxels_.size(); }

  /// Centroids relative to the origin, sorted by voxel (z, y, x), hence independent of the order of the points up to
  /// rounding.
  Points centroids() const;

 private:
  struct Voxel {
    std::uint64_t key;
    std::uint32_t count;
    Eigen::Vector3d sum;
  };
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
