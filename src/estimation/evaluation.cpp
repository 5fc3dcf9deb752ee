#include "igsp/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "igsp/errors.hpp"

namespace igsp {

double rotation_error_rad(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  // The arccos of Eq. 13 loses half of the digits at small angles and the arcsin of the chord at large ones; the
  // quaternion's half angle by atan2 loses none.
  const Eigen::Quaterniond q(Eigen::Matrix3d(a * b.transpose()));
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

PoseError pose_error(const Transformation& estimate, const Transformation& truth,
                     const Eigen::Vector3d& source_centroid) {
  PoseError error;
  error.rotation_rad = rotation_error_rad(estimate.linear(), truth.linear());
  // dT = T T_gt^-1: dt = t - dR t_gt
  const Eigen::Matrix3d delta_rotation = estimate.linear() * truth.linear().transpose();
  error.translation = (estimate.translation() - delta_rotation * truth.translation()).norm();
  error.centroid_displacement = (estimate * source_centroid - truth * source_centroid).norm();
  return error;
}

MatchQuality match_quality(std::span<const KeypointMatch> correspondences, PointView source_keypoints,
                           PointView target_keypoints, const Transformation& truth, double radius) {
  if (!(radius > 0)) throw InvalidArgument(fmt::format("radius is {}; it must be greater than 0", radius));
  Points moved;
  moved.reserve(source_keypoints.size());
  for (const Eigen::Vector3d& keypoint : source_keypoints) moved.push_back(truth * keypoint);
  const auto is_true_pair = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).squaredNorm() < radius * radius;
  };
  MatchQuality quality;
  quality.matched = correspondences.size();
  for (const KeypointMatch& match : correspondences) {
    if (match.source >= moved.size() || match.target >= target_keypoints.size()) {
      throw InvalidArgument(fmt::format("correspondences has ({}, {}); there are {} source and {} target keypoints",
                                        match.source, match.target, moved.size(), target_keypoints.size()));
    }
    if (is_true_pair(moved[match.source], target_keypoints[match.target])) ++quality.correct;
  }
  // All pairs: a few thousand keypoints at most, and this is no part of a registration.
  quality.possible = static_cast<std::size_t>(std::count_if(moved.begin(), moved.end(), [&](const Eigen::Vector3d& a) {
    return std::any_of(target_keypoints.begin(), target_keypoints.end(),
                       [&](const Eigen::Vector3d& b) { return is_true_pair(a, b); });
  }));
  return quality;
}

}  // namespace igsp
