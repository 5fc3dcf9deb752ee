#pragma once

#include <cstddef>
#include <span>

#include "igsp/point_cloud.hpp"
#include "igsp/result.hpp"

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

/// Correspondences against ground truth (Eq. 14).
struct MatchQuality {
  std::size_t correct = 0;   ///< of the correspondences: closer than the radius at the true transformation
  std::size_t matched = 0;   ///< all correspondences
  std::size_t possible = 0;  ///< source keypoints with a target keypoint within the radius at the true transformation
  double precision() const { return matched == 0 ? 0.0 : static_cast<double>(correct) / static_cast<double>(matched); }
  double recall() const { return possible == 0 ? 0.0 : static_cast<double>(correct) / static_cast<double>(possible); }
};

/// `correspondences` are indices into the keypoints, both in their own frames, as a Result holds them. `radius` in the
/// unit of the cloud, > 0; the usual choice is a third of the suppression radius r_k. Throws InvalidArgument for an
/// index beyond the keypoints or another radius.
MatchQuality match_quality(std::span<const KeypointMatch> correspondences, PointView source_keypoints,
                           PointView target_keypoints, const Transformation& truth, double radius);

}  // namespace igsp
