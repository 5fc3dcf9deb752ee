#pragma once

#include <cstdint>
#include <vector>

#include "igsp/point_cloud.hpp"
#include "registration/range_image.hpp"

namespace igsp::cli {

/// What the scanner of a cloud, or of a part of it, saw. `points` and `viewpoint` are relative to about the cloud's
/// centre.
RangeImage range_image_of(PointView points, const Eigen::Vector3d& viewpoint, double voxel_size);

/// Of every point of another cloud: 1 where it lies in space that one of the scanners of a cloud saw through, else 0.
std::vector<std::uint8_t> seen_through(PointView points, const std::vector<RangeImage>& seen,
                                       const Transformation& seen_from_points, int threads);

}  // namespace igsp::cli
