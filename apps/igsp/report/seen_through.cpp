#include "report/seen_through.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "spatial/voxel_grid.hpp"

namespace igsp::cli {

// Half a voxel apart, as the evidence has it.
RangeImage range_image_of(PointView points, const Eigen::Vector3d& viewpoint, double voxel_size) {
  return RangeImage(voxel_centroids(points, Eigen::Vector3d::Zero(), voxel_size / 2), viewpoint, voxel_size);
}

std::vector<std::uint8_t> seen_through(PointView points, const std::vector<RangeImage>& seen,
                                       const Transformation& seen_from_points, int threads) {
  std::vector<std::uint8_t> empty(points.size());
  parallel_blocks(empty.size(), threads, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d point = seen_from_points * points[i];
      empty[i] = std::ranges::any_of(
          seen, [&](const RangeImage& image) { return image.look_at(point).sight == RangeImage::Sight::empty; });
    }
  });
  return empty;
}

}  // namespace igsp::cli
