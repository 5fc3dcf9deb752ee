#pragma once

#include <Eigen/Core>

#include "igsp/point_cloud.hpp"

namespace igsp {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// A step is a small motion in some frame: a rotation vector [rad] about a centre, then a translation.

Transformation motion_about(const Eigen::Vector3d& centre, const Vector6& step);

/// The inverse of motion_about, for rotations below half a turn.
Vector6 step_about(const Eigen::Vector3d& centre, const Transformation& motion);

/// Takes a small step about `centre_a` in frame a to the step about `centre_b` in frame b that is the same motion.
Matrix6 transport(const Transformation& b_from_a, const Eigen::Vector3d& centre_a, const Eigen::Vector3d& centre_b);

/// How the rotation vector of a step changes when another, small one is applied after it: step + this * other.
Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& rotation);

}  // namespace igsp
