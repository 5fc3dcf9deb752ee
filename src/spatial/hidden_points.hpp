#pragma once

#include "igsp/viewpoint.hpp"
#include "spatial/trimmed_cloud.hpp"

namespace igsp {

/// hidden_points of a cloud whose stray points are known already. `viewpoint` is finite, `to_a_right_angle` in range.
HiddenPoints hidden_points(const TrimmedCloud& cloud, const Eigen::Vector3d& viewpoint, int to_a_right_angle);

/// Whether the cloud looks as if its scanner had stood at the origin of its coordinates: one depth a direction from
/// there, and not from places about it. In doubt unknown, as for clouds fused from several scans.
ViewpointFinding viewpoint_at_origin(PointView points);

}  // namespace igsp
