#include "network/pose_equations.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace igsp {
namespace {

using Solver = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

}  // namespace

PoseEquations::PoseEquations(std::span<const Eigen::Vector3d> centres, const std::vector<bool>& is_free)
    : centres_(centres), unknown_(centres.size(), stays) {
  for (std::size_t i = 0; i < centres.size(); ++i) {
    if (is_free[i]) unknown_[i] = unknowns_++;
  }
  gradient_ = Eigen::VectorXd::Zero(6 * unknowns_);
}

void PoseEquations::add(const RelativeFactor& factor) {
  const std::size_t scans[2] = {factor.source, factor.target};
  const Matrix6 jacobians[2] = {
      transport(factor.target_from_source, centres_[factor.source], factor.centre),
      -transport(Transformation::Identity(), centres_[factor.target], factor.centre),
  };
  for (int a = 0; a < 2; ++a) {
    if (unknown_[scans[a]] == stays) continue;
    const std::size_t row = 6 * unknown_[scans[a]];
    gradient_.segment<6>(row) += jacobians[a].transpose() * factor.gradient;
    for (int b = 0; b < 2; ++b) {
      if (unknown_[scans[b]] == stays) continue;
      const Matrix6 block = jacobians[a].transpose() * factor.information * jacobians[b];
      const std::size_t column = 6 * unknown_[scans[b]];
      for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) entries_.emplace_back(row + i, column + j, block(i, j));
      }
    }
  }
}

Eigen::SparseMatrix<double> PoseEquations::information() const {
  Eigen::SparseMatrix<double> matrix(6 * unknowns_, 6 * unknowns_);
  matrix.setFromTriplets(entries_.begin(), entries_.end());
  return matrix;
}

std::optional<std::vector<Vector6>> PoseEquations::solve() const {
  std::vector<Vector6> steps(unknown_.size(), Vector6::Zero());
  if (unknowns_ == 0) return steps;
  const Solver solver(information());
  if (solver.info() != Eigen::Success || solver.vectorD().minCoeff() <= 0) return {};
  const Eigen::VectorXd solution = solver.solve(-gradient_);
  if (!solution.allFinite()) return {};
  for (std::size_t i = 0; i < unknown_.size(); ++i) {
    if (unknown_[i] != stays) steps[i] = solution.segment<6>(6 * unknown_[i]);
  }
  return steps;
}

std::vector<Matrix6> PoseEquations::covariances() const {
  std::vector<Matrix6> blocks(unknown_.size(), Matrix6::Zero());
  if (unknowns_ == 0) return blocks;
  const Solver solver(information());
  if (solver.info() != Eigen::Success || solver.vectorD().minCoeff() <= 0) return blocks;
  for (std::size_t i = 0; i < unknown_.size(); ++i) {
    if (unknown_[i] == stays) continue;
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(6 * unknowns_, 6);
    unit.middleRows<6>(6 * unknown_[i]).setIdentity();
    blocks[i] = solver.solve(unit).middleRows<6>(6 * unknown_[i]);
  }
  return blocks;
}

double apply_steps(std::span<const Vector6> steps, std::span<const Eigen::Vector3d> centres,
                   std::vector<Transformation>& world_from_scan) {
  double largest = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].isZero(0)) continue;
    largest = std::max(largest, steps[i].lpNorm<Eigen::Infinity>());
    world_from_scan[i] = world_from_scan[i] * motion_about(centres[i], steps[i]);
    world_from_scan[i].linear() = Eigen::Quaterniond(world_from_scan[i].linear()).normalized().toRotationMatrix();
  }
  return largest;
}

}  // namespace igsp
