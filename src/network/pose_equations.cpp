#include "network/pose_equations.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace igsp {
namespace {

using Solver = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

}  // namespace

PoseEquations::PoseEquations(std::span<const Eigen::Vector3d> centres, const std::vector<bool>& is_free,
                             int degrees_of_freedom)
    : centres_(centres), size_(degrees_of_freedom), unknown_(centres.size(), stays) {
  for (std::size_t i = 0; i < centres.size(); ++i) {
    if (is_free[i]) unknown_[i] = unknowns_++;
  }
  gradient_ = Eigen::VectorXd::Zero(size_ * unknowns_);
}

void PoseEquations::add_block(std::size_t row, std::size_t column, const Matrix6& block) {
  const int first = 6 - size_;
  for (int i = 0; i < size_; ++i) {
    for (int j = 0; j < size_; ++j) {
      entries_.emplace_back(size_ * row + i, size_ * column + j, block(first + i, first + j));
    }
  }
}

void PoseEquations::add(const RelativeFactor& factor) {
  const std::size_t scans[2] = {factor.source, factor.target};
  const Matrix6 jacobians[2] = {
      transport(factor.target_from_source, centres_[factor.source], factor.centre),
      -transport(Transformation::Identity(), centres_[factor.target], factor.centre),
  };
  for (int a = 0; a < 2; ++a) {
    if (unknown_[scans[a]] == stays) continue;
    const Vector6 gradient = jacobians[a].transpose() * factor.gradient;
    gradient_.segment(size_ * unknown_[scans[a]], size_) += gradient.tail(size_);
    for (int b = 0; b < 2; ++b) {
      if (unknown_[scans[b]] == stays) continue;
      add_block(unknown_[scans[a]], unknown_[scans[b]], jacobians[a].transpose() * factor.information * jacobians[b]);
    }
  }
}

void PoseEquations::add(const PriorFactor& factor) {
  const std::size_t place = unknown_[factor.scan];
  if (place == stays) return;
  gradient_.segment(size_ * place, size_) += factor.gradient.tail(size_);
  add_block(place, place, factor.information);
}

Eigen::SparseMatrix<double> PoseEquations::information() const {
  Eigen::SparseMatrix<double> matrix(size_ * unknowns_, size_ * unknowns_);
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
    if (unknown_[i] != stays) steps[i].tail(size_) = solution.segment(size_ * unknown_[i], size_);
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
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(size_ * unknowns_, size_);
    unit.middleRows(size_ * unknown_[i], size_).setIdentity();
    blocks[i].bottomRightCorner(size_, size_) = solver.solve(unit).middleRows(size_ * unknown_[i], size_);
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
