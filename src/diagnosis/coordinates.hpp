#pragma once

#include <optional>

#include "igsp/diagnosis.hpp"

namespace igsp {

// Each looks at the coordinates alone, in time linear in the points, and names the cloud that is to blame, or both.

std::optional<Diagnosis> too_few_points(PointView source, PointView target);

std::optional<Diagnosis> flat(PointView source, PointView target);

/// x and y within the range of longitude and latitude, far from their origin for their extent, and far smaller in
/// extent than the heights.
std::optional<Diagnosis> degrees(PointView source, PointView target);

/// Every coordinate of an axis is a multiple of a step, which is more than a quarter of a voxel.
std::optional<Diagnosis> coarse_coordinates(PointView source, PointView target, double voxel_size);

}  // namespace igsp
