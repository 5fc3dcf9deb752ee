#pragma once

#include "spatial/scale.hpp"

namespace igsp {

/// The unit that the method computes in [units of the cloud]: 1 for every cloud whose voxels lie between 2^-10 and
/// 2^10, otherwise a power of two near the voxel size, so that single precision never overflows nor underflows and
/// nothing but the exponents changes. `voxel_size` 0: yet to be chosen. Throws InvalidArgument, with the numbers as
/// given, where the ratio of extent and voxel size is beyond what the voxel filter holds.
double unit_of_length(const Bounds& source, const Bounds& target, double voxel_size);

/// The points in another unit. Dividing by a power of two is exact.
Points in_unit(PointView points, double unit);

/// The same for places far from the points; throw InvalidArgument with the place where that is beyond doubles.
Eigen::Vector3d in_unit(const Eigen::Vector3d& place, double unit, std::string_view name);

std::optional<Eigen::Vector3d> in_unit(const std::optional<Eigen::Vector3d>& viewpoint, double unit);

}  // namespace igsp
