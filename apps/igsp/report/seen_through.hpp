#pragma once

#include <cstdint>
#include <vector>

#include "igsp/point_cloud.hpp"
#include "registration/range_image.hpp"

namespace igsp::cli {

/// What the scanner of a cloud saw. `points` and `viewpoint` are relative to about the cloud's centre.
RangeImage range_image_of(PointView points, const Eigen::Vector3d& viewpoint, double voxel_size);

/// Of every point of another cloud: 1 where it lies in space that this scanner saw through, else 0.
std::vector<std::uint8_t> seen_through(PointView points, const RangeImage& scanner,
                                       const Transformation& scanner_from_points, int threads);

}  // namespace igsp::cli
