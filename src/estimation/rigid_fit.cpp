#include "estimation/rigid_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

namespace igsp {
namespace {

constexpr double collinear = 1e-6;  // spread across the line as a share of the spread along it

struct Centred {
  std::size_t used = 0;
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();          // sum w (target - mean) (source - mean)^T
  Eigen::Matrix3d source_spread = Eigen::Matrix3d::Zero();  // sum w (source - mean) (source - mean)^T
  Eigen::Matrix3d target_spread = Eigen::Matrix3d::Zero();
};

Centred centre(std::span<const PointPair> pairs) {
  Centred c;
  double weight = 0;
  for (const PointPair& pair : pairs) {
    if (!(pair.weight > 0)) continue;
    ++c.used;
    weight += pair.weight;
    c.source_mean += pair.weight * pair.source;
    c.target_mean += pair.weight * pair.target;
  }
  if (c.used == 0) return c;
  c.source_mean /= weight;
  c.target_mean /= weight;
  for (const PointPair& pair : pairs) {
    if (!(pair.weight > 0)) continue;
    const Eigen::Vector3d s = pair.source - c.source_mean, t = pair.target - c.target_mean;
    c.cross += pair.weight * t * s.transpose();
    c.source_spread += pair.weight * s * s.transpose();
    c.target_spread += pair.weight * t * t.transpose();
  }
  return c;
}

// Two extents are needed to fix a rotation.
bool lies_on_a_line(const Eigen::Matrix3d& spread) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& spreads = solver.eigenvalues();  // ascending
  return !(spreads[1] > collinear * collinear * spreads[2]) || spreads[2] == 0;
}

Transformation assemble(const Eigen::Matrix3d& rotation, const Centred& c) {
  Transformation result = Transformation::Identity();
  result.linear() = rotation;
  result.translation() = c.target_mean - rotation * c.source_mean;
  return result;
}

}  // namespace

std::optional<Transformation> rigid_fit(std::span<const PointPair> pairs) {
  const Centred c = centre(pairs);
  if (c.used < 3 || lies_on_a_line(c.source_spread) || lies_on_a_line(c.target_spread)) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(c.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs[2] = -1;
  return assemble(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose(), c);
}

std::optional<Transformation> levelled_rigid_fit(std::span<const PointPair> pairs) {
  const Centred c = centre(pairs);
  if (c.used < 2) return std::nullopt;
  const double sine = c.cross(1, 0) - c.cross(0, 1), cosine = c.cross(0, 0) + c.cross(1, 1);
  const double spread = c.source_spread.topLeftCorner<2, 2>().trace() + c.target_spread.topLeftCorner<2, 2>().trace();
  if (!(std::hypot(sine, cosine) > collinear * spread)) return std::nullopt;
  return assemble(Eigen::AngleAxisd(std::atan2(sine, cosine), Eigen::Vector3d::UnitZ()).toRotationMatrix(), c);
}

std::optional<Transformation> rigid_fit(std::span<const PointPair> pairs, int degrees_of_freedom) {
  return degrees_of_freedom == 4 ? levelled_rigid_fit(pairs) : rigid_fit(pairs);
}

}  // namespace igsp
