#include "igsp/evaluation.hpp"

#include <cmath>

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

}  // namespace igsp
