#include "network/small_motion.hpp"

#include <cmath>

namespace igsp {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return matrix;
}

}  // namespace

Transformation motion_about(const Eigen::Vector3d& centre, const Vector6& step) {
  const Eigen::Vector3d rotation = step.head<3>();
  const double angle = rotation.norm();
  Transformation motion = Transformation::Identity();
  if (angle > 0) motion.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  motion.translation() = centre + step.tail<3>() - motion.linear() * centre;
  return motion;
}

Vector6 step_about(const Eigen::Vector3d& centre, const Transformation& motion) {
  Eigen::Quaterniond q(motion.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  const double factor = sine > 0 ? 2 * std::atan2(sine, q.w()) / sine : 2.0;
  Vector6 step;
  step << factor * q.vec(), motion * centre - centre;
  return step;
}

Matrix6 transport(const Transformation& b_from_a, const Eigen::Vector3d& centre_a, const Eigen::Vector3d& centre_b) {
  const Eigen::Matrix3d rotation = b_from_a.linear();
  Matrix6 matrix = Matrix6::Zero();
  matrix.topLeftCorner<3, 3>() = rotation;
  matrix.bottomRightCorner<3, 3>() = rotation;
  matrix.bottomLeftCorner<3, 3>() = -cross_matrix(centre_b - b_from_a * centre_a) * rotation;
  return matrix;
}

Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  const Eigen::Matrix3d cross = cross_matrix(rotation);
  const double squared = angle * angle;
  const double second = angle < 1e-4 ? 1.0 / 12.0 : (1 - 0.5 * angle / std::tan(0.5 * angle)) / squared;
  return Eigen::Matrix3d::Identity() - 0.5 * cross + second * cross * cross;
}

}  // namespace igsp
