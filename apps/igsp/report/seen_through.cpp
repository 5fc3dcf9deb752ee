#include "report/seen_through.hpp"

#include "core/parallel.hpp"
#include "spatial/voxel_grid.hpp"

namespace igsp::cli {

// Half a voxel apart, as the evidence has it.
RangeImage range_image_of(PointView points, const Eigen::Vector3d& viewpoint, double voxel_size) {
  return RangeImage(voxel_centroids(points, Eigen::Vector3d::Zero(), voxel_size / 2), viewpoint, voxel_size);
}

std::vector<std::uint8_t> seen_through(PointView points, const RangeImage& scanner,
                                       const Transformation& scanner_from_points, int threads) {
  std::vector<std::uint8_t> empty(points.size());
  parallel_blocks(empty.size(), threads, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      empty[i] = scanner.look_at(scanner_from_points * points[i]).sight == RangeImage::Sight::empty;
    }
  });
  return empty;
}

}  // namespace igsp::cli
