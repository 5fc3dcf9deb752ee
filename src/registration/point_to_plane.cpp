#include "registration/point_to_plane.hpp"

#include <Eigen/Cholesky>

#include "estimation/robust_fit.hpp"

namespace igsp {
namespace {

constexpr double min_normal_cosine = 0.7;
constexpr std::size_t min_pairs = 30;

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

struct NormalEquations {
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  std::size_t pairs = 0;
};

// Unknowns: a small rotation about `centre`, then a translation.
NormalEquations accumulate(const PreparedCloud& source, const PreparedCloud& target, const Transformation& pose,
                           const Eigen::Vector3d& centre, std::size_t stride, double radius) {
  NormalEquations equations;
  for (std::size_t i = 0; i < source.features.points.size(); i += stride) {
    const Eigen::Vector3d p = pose * source.features.points[i];
    const std::int64_t j = target.grid.nearest(p.cast<float>(), static_cast<float>(radius));
    if (j < 0) continue;
    const Eigen::Vector3d& n = target.features.normals[j];
    if (std::abs(n.dot(pose.linear() * source.features.normals[i])) < min_normal_cosine) continue;
    const double residual = n.dot(p - target.features.points[j]);
    const double weight = geman_mcclure_weight(residual, 0.5 * radius);
    Vector6 jacobian;
    jacobian << (p - centre).cross(n), n;
    equations.information += weight * jacobian * jacobian.transpose();
    equations.gradient += weight * residual * jacobian;
    ++equations.pairs;
  }
  return equations;
}

Transformation motion(const Vector6& step, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d rotation = step.head<3>();
  const double angle = rotation.norm();
  Transformation result = Transformation::Identity();
  if (angle > 0) result.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  result.translation() = centre + step.tail<3>() - result.linear() * centre;
  return result;
}

// Levelled scans: yaw and translation only, so the two tilts are taken out of the equations.
void fix_tilt(NormalEquations& equations) {
  for (int axis = 0; axis < 2; ++axis) {
    equations.information.row(axis).setZero();
    equations.information.col(axis).setZero();
    equations.information(axis, axis) = 1;
    equations.gradient[axis] = 0;
  }
}

}  // namespace

Transformation refine_point_to_plane(const PreparedCloud& source, const PreparedCloud& target,
                                     const Transformation& initial, const PointToPlaneOptions& options) {
  Transformation pose = initial;
  const std::size_t stride = std::max<std::size_t>(1, source.features.points.size() / options.max_points);
  for (const double radius : options.radii) {
    const Eigen::Vector3d centre = pose.translation();
    NormalEquations equations =
        accumulate(source, target, pose, centre, stride, radius * target.features.voxel_size);
    if (equations.pairs < min_pairs) break;
    if (options.degrees_of_freedom == 4) fix_tilt(equations);
    const Eigen::LDLT<Matrix6> solver(equations.information);
    if (solver.info() != Eigen::Success || !solver.isPositive() || solver.rcond() < 1e-12) break;
    pose = motion(solver.solve(-equations.gradient), centre) * pose;
  }
  pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return pose;
}

}  // namespace igsp
