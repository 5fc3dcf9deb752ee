#pragma once

#include <vector>

#include "igsp/options.hpp"
#include "igsp/point_cloud.hpp"

namespace igsp {

/// The voxel size that a scan would have by itself. Throws InvalidArgument as choose_voxel_size does.
double own_voxel_size(const Scan& scan, const ScaleOptions& options);

/// One voxel size for scans that would have these: the median, so that a scan of a few points, or of a hall among
/// rooms, does not decide for all. 0 of none.
double common_voxel_size(std::vector<double> own);

}  // namespace igsp
