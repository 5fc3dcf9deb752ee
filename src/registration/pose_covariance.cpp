#include "registration/pose_covariance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "estimation/robust_fit.hpp"

namespace igsp {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Residuals of a tree, a wall or a piece of furniture are alike: seen from elsewhere all of it lies a little off.
// Smaller patches than these cover too little (docs/covariance.md).
constexpr double patch_size = 32;  // voxels, but no larger than the root mean square size of what lies on each other
constexpr double unknowns = 6;
// What whole scenes share, such as the side from which both scanners see them, no patch tells. Of simulated parks,
// rooms and objects, each 12 scenes in 10 draws, the ellipsoids of 95 % held 85, 89 and 93 % without this.
constexpr double beyond_patches = 1.3;

struct Weighted {
  double loss_scale = 0, sum = 0, squares = 0;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  double weight_of(const PlanePair& pair) const {
    return geman_mcclure_weight(pair.residual * pair.residual, loss_scale * loss_scale);
  }
};

// As the last steps of the refinement weigh them: the scale of the loss follows the residuals.
Weighted weigh(std::span<const PlanePair> pairs, double radius, double voxel_size) {
  Weighted result;
  result.loss_scale = 0.5 * radius;
  for (int k = 0; k < 3; ++k) {
    Weighted next;
    next.loss_scale = k == 0 ? result.loss_scale : loss_scale_of(result.squares / result.sum, radius, voxel_size);
    for (const PlanePair& pair : pairs) {
      const double weight = next.weight_of(pair);
      next.sum += weight;
      next.squares += weight * pair.residual * pair.residual;
      next.centroid += weight * pair.place;
    }
    if (!(next.sum > 0)) return {};
    next.centroid /= next.sum;
    result = next;
  }
  return result;
}

double weighted_size(std::span<const PlanePair> pairs, const Weighted& weighted) {
  double squares = 0;
  for (const PlanePair& pair : pairs)
    squares += weighted.weight_of(pair) * (pair.place - weighted.centroid).squaredNorm();
  return std::sqrt(squares / weighted.sum);
}

struct Patch {
  Vector6 gradient = Vector6::Zero();
  double weight = 0;
};

// Sums over all pairs, and the gradients of patches in the order of their places.
struct PairSums {
  Matrix6 hessian = Matrix6::Zero();
  std::map<std::array<std::int64_t, 3>, Patch> patches;
};

PairSums sum_up(std::span<const PlanePair> pairs, const Weighted& weighted, double patch) {
  PairSums sums;
  for (const PlanePair& pair : pairs) {
    const Eigen::Vector3d place = pair.place - weighted.centroid;
    const double weight = weighted.weight_of(pair);
    Vector6 jacobian;
    jacobian << place.cross(pair.normal), pair.normal;
    sums.hessian += weight * jacobian * jacobian.transpose();
    // All pairs at one place are one patch, of no size.
    Eigen::Vector3d cell = Eigen::Vector3d::Zero();
    if (patch > 0) cell = (place / patch).array().floor();
    Patch& at = sums.patches[{static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
                              static_cast<std::int64_t>(cell.z())}];
    at.gradient += weight * pair.residual * jacobian;
    at.weight += weight;
  }
  return sums;
}

// Whether every motion changes some distance; in no unit of its own.
bool is_determined(const Matrix6& hessian) {
  if (!(hessian.diagonal().minCoeff() > 0)) return false;
  const Vector6 scale = hessian.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix6> solver(scale.asDiagonal() * hessian * scale.asDiagonal());
  return solver.info() == Eigen::Success && solver.vectorD().minCoeff() > 1e-12;
}

// Column by column: with several of them at a time Eigen adds up in another order on each family of processors.
Matrix6 solve(const Matrix6& matrix, const Matrix6& right) {
  const Eigen::LDLT<Matrix6> solver(matrix);
  Matrix6 result;
  for (int i = 0; i < 6; ++i) result.col(i) = solver.solve(Vector6(right.col(i)));
  return result;
}

// H^-1 B H^-1.
Matrix6 sandwich(const Matrix6& hessian, const Matrix6& scatter) {
  const Matrix6 half = solve(hessian, scatter);
  const Matrix6 covariance = solve(hessian, half.transpose());
  return 0.5 * (covariance + covariance.transpose());
}

// With 4 degrees of freedom rotations about x and y are known: what errors they would have does not depend on the
// others, nor do the others' errors on them.
Matrix6 without_tilt(Matrix6 matrix, int degrees_of_freedom) {
  if (degrees_of_freedom == 4) {
    matrix.topRightCorner<2, 4>().setZero();
    matrix.bottomLeftCorner<4, 2>().setZero();
  }
  return matrix;
}

// Covariance of the gradient.
Matrix6 scatter_of(const PairSums& sums, double weight_sum, double residual_variance) {
  Matrix6 scatter = Matrix6::Zero();
  double squares = 0;
  for (const auto& [cell, patch] : sums.patches) {
    scatter += patch.gradient * patch.gradient.transpose();
    squares += patch.weight * patch.weight;
  }
  // As many patches of one weight would scatter alike. The estimate follows six of their directions.
  const double patches = weight_sum * weight_sum / squares;
  scatter *= patches / std::max(1.0, patches - unknowns);
  return scatter + std::min(1.0, unknowns / patches) * residual_variance * sums.hessian;
}

}  // namespace

PoseCovariance pose_covariance(std::span<const PlanePair> pairs, double radius, double voxel_size,
                               int degrees_of_freedom) {
  PoseCovariance result;
  const Weighted weighted = weigh(pairs, radius, voxel_size);
  if (!(weighted.sum > 0)) return result;
  result.centre = weighted.centroid;
  result.residual_variance = weighted.squares / weighted.sum;
  if (!(result.residual_variance > 0)) return result;
  const double patch = std::min(patch_size * voxel_size, weighted_size(pairs, weighted));
  const PairSums sums = sum_up(pairs, weighted, patch);
  const Matrix6 scatter = scatter_of(sums, weighted.sum, result.residual_variance);
  result.curvature = sums.hessian / result.residual_variance;
  result.gradient_covariance = beyond_patches / (result.residual_variance * result.residual_variance) * scatter;
  result.information = result.curvature;
  if (!is_determined(sums.hessian)) return result;
  result.covariance = beyond_patches * sandwich(without_tilt(sums.hessian, degrees_of_freedom),
                                                without_tilt(scatter, degrees_of_freedom));
  result.information = solve(result.covariance, Matrix6::Identity());
  return result;
}

}  // namespace igsp
