#pragma once

#include "igsp/options.hpp"
#include "spatial/trimmed_cloud.hpp"

namespace igsp {

/// One voxel size for both clouds: the geometric mean of their voxel counts comes to options.target_points, yet no
/// cloud is cut finer than its own spacing (at least 10 points to 6 voxels, about), nor so fine that on
/// average more than 60 % of the voxels hold a single point, as those far from a scanner do: they show no surface.
/// Returns options.voxel_size if it is set. Scales with the unit of length. Throws InvalidArgument when all points of
/// both clouds coincide.
double choose_voxel_size(const TrimmedCloud& source, const TrimmedCloud& target, const ScaleOptions& options,
                         int threads = 1);

/// The same for clouds as they are; their stray points are left out.
double choose_voxel_size(PointView source, PointView target, const ScaleOptions& options);

}  // namespace igsp
