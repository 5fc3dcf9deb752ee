#pragma once

#include "igsp/point_cloud.hpp"

namespace igsp {

/// Angle of the rotation between two rotations, radians in [0, pi]: e_r of Eq. 13, without loss at small angles.
double rotation_error_rad(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

struct PoseError {
  double rotation_rad = 0.0;           ///< e_r, Eq. 13
  double translation = 0.0;            ///< e_t = |dt| of dT = T T_gt^-1 (Eq. 12-13); depends on the origin
  double centroid_displacement = 0.0;  ///< |T c - T_gt c| for the given centroid c: independent of the origin
};

/// Error of `estimate` against `truth`, both target_from_source; `source_centroid` in the source's frame.
PoseError pose_error(const Transformation& estimate, const Transformation& truth,
                     const Eigen::Vector3d& source_centroid);

}  // namespace igsp
