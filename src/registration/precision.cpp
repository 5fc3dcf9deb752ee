#include "registration/precision.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace igsp {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// A direction is free when moving along it changes distances to the surface by less than this share of the motion (root
// mean square). Normals of simulated planes, spheres and cylinders stay below 0.03, scenes with corners above 0.08.
constexpr double free_share = 0.04;
constexpr std::size_t slippage_points = 1500;

std::string describe(const Vector6& motion) {
  const Eigen::Vector3d rotation = motion.head<3>(), translation = motion.tail<3>();
  const auto axis = [](Eigen::Vector3d a) {
    a.normalize();
    Eigen::Index largest;
    a.cwiseAbs().maxCoeff(&largest);
    if (a[largest] < 0) a = -a;
    return fmt::format("({:.2f}, {:.2f}, {:.2f})", a.x(), a.y(), a.z());
  };
  if (rotation.norm() < 0.3) return "translation along " + axis(translation);
  // Translation across the axis only moves the axis; translation along it makes a screw.
  const double along = std::abs(rotation.normalized().dot(translation));
  return (along < 0.3 ? "rotation about " : "screw motion about ") + axis(rotation);
}

// `mean` is J^T J averaged over points with unit normals and rotations scaled by the size.
std::vector<FreeDirection> free_directions(const Matrix6& mean) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(mean);
  std::vector<FreeDirection> found;
  for (int i = 0; i < 6; ++i) {
    if (solver.eigenvalues()[i] > free_share * free_share) break;
    const Vector6 motion = solver.eigenvectors().col(i);
    found.push_back({motion, describe(motion)});
  }
  return found;
}

Eigen::Vector3d centre_of(const Surface& surface) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < surface.size(); ++i) sum += surface.point(i);
  return sum / std::max<double>(1.0, static_cast<double>(surface.size()));
}

Matrix6 unit_rotations(const Matrix6& hessian, double size) {
  Vector6 scale;
  scale << Eigen::Vector3d::Constant(1 / size), Eigen::Vector3d::Ones();
  return scale.asDiagonal() * hessian * scale.asDiagonal();
}

}  // namespace

Precision precision_of(const Linearisation& linearisation, double size) {
  Precision precision;
  precision.centre = linearisation.centre;
  if (linearisation.pairs == 0 || !(linearisation.residual_variance > 0)) return precision;
  // Every pair is met from both sides, so half of them are independent.
  precision.information = 0.5 * linearisation.hessian / linearisation.residual_variance;
  const Matrix6 scaled = unit_rotations(linearisation.hessian, size);
  precision.free_directions = free_directions(scaled / scaled.bottomRightCorner<3, 3>().trace());
  if (precision.free_directions.empty()) precision.covariance = precision.information.ldlt().solve(Matrix6::Identity());
  return precision;
}

double size_of(const Surface& surface) {
  const Eigen::Vector3d centre = centre_of(surface);
  double squares = 0;
  for (std::size_t i = 0; i < surface.size(); ++i) squares += (surface.point(i) - centre).squaredNorm();
  return surface.size() > 0 ? std::sqrt(squares / static_cast<double>(surface.size())) : 0.0;
}

std::vector<FreeDirection> slippable_motions(Surface& surface) {
  const double size = size_of(surface);
  if (!(size > 0)) return {};
  const Eigen::Vector3d centre = centre_of(surface);
  Matrix6 sum = Matrix6::Zero();
  std::size_t count = 0;
  for (std::size_t i = 0; i < surface.size(); i += std::max<std::size_t>(1, surface.size() / slippage_points)) {
    Vector6 jacobian;
    jacobian << (surface.point(i) - centre).cross(surface.normal(i)), surface.normal(i);
    sum += jacobian * jacobian.transpose();
    ++count;
  }
  return free_directions(unit_rotations(sum, size) / static_cast<double>(count));
}

}  // namespace igsp
