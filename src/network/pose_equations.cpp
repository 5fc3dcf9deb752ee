#include "network/pose_equations.hpp"

#include <algorithm>
#include <array>

namespace igsp {
namespace {

bool is_positive(const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>& solver) {
  return solver.info() == Eigen::Success && solver.vectorD().minCoeff() > 0;
}

// Of the step between two scans, by the steps of source and target.
std::array<Matrix6, 2> jacobians_of(const RelativeFactor& factor, std::span<const Eigen::Vector3d> centres) {
  return {transport(factor.target_from_source, centres[factor.source], factor.centre),
          -transport(Transformation::Identity(), centres[factor.target], factor.centre)};
}

}  // namespace

PoseEquations::PoseEquations(std::span<const Eigen::Vector3d> centres, const std::vector<bool>& is_free,
                             int degrees_of_freedom)
    : centres_(centres), size_(degrees_of_freedom), unknown_(centres.size(), stays) {
  for (std::size_t i = 0; i < centres.size(); ++i) {
    if (is_free[i]) unknown_[i] = unknowns_++;
  }
  gradient_ = Eigen::VectorXd::Zero(size_ * unknowns_);
}

void PoseEquations::add_block(std::size_t row, std::size_t column, const Matrix6& block, Entries& entries) const {
  const int first = 6 - size_;
  for (int i = 0; i < size_; ++i) {
    for (int j = 0; j < size_; ++j) {
      entries.emplace_back(size_ * row + i, size_ * column + j, block(first + i, first + j));
    }
  }
}

void PoseEquations::add_between(const RelativeFactor& factor, const Matrix6& block, Entries& entries) const {
  const std::size_t scans[2] = {factor.source, factor.target};
  const auto jacobians = jacobians_of(factor, centres_);
  for (int a = 0; a < 2; ++a) {
    if (unknown_[scans[a]] == stays) continue;
    for (int b = 0; b < 2; ++b) {
      if (unknown_[scans[b]] == stays) continue;
      add_block(unknown_[scans[a]], unknown_[scans[b]], jacobians[a].transpose() * block * jacobians[b], entries);
    }
  }
}

void PoseEquations::add(const RelativeFactor& factor) {
  const std::size_t scans[2] = {factor.source, factor.target};
  const auto jacobians = jacobians_of(factor, centres_);
  for (int a = 0; a < 2; ++a) {
    if (unknown_[scans[a]] == stays) continue;
    const Vector6 gradient = jacobians[a].transpose() * factor.gradient;
    gradient_.segment(size_ * unknown_[scans[a]], size_) += gradient.tail(size_);
  }
  add_between(factor, factor.information, information_);
  if (factor.scatter) {
    shared_.push_back(factor);
  } else {
    add_between(factor, factor.information, scatter_);
  }
}

void PoseEquations::add(const PriorFactor& factor) {
  const std::size_t place = unknown_[factor.scan];
  if (place == stays) return;
  gradient_.segment(size_ * place, size_) += factor.gradient.tail(size_);
  add_block(place, place, factor.information, information_);
  add_block(place, place, factor.information, scatter_);
}

Eigen::SparseMatrix<double> PoseEquations::matrix_of(const Entries& entries) const {
  Eigen::SparseMatrix<double> matrix(size_ * unknowns_, size_ * unknowns_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// How much of what is known of the step between two scans comes from this factor, (0, 1]: 1 for the only link, 2 / n if
// n scans are linked all with all.
double PoseEquations::share_of(const RelativeFactor& factor, const Solver& solver) const {
  const std::size_t scans[2] = {factor.source, factor.target};
  const auto jacobians = jacobians_of(factor, centres_);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(size_ * unknowns_, 6);
  for (int a = 0; a < 2; ++a) {
    if (unknown_[scans[a]] == stays) continue;
    columns.middleRows(size_ * unknown_[scans[a]], size_) += jacobians[a].transpose().bottomRows(size_);
  }
  const Matrix6 covariance = columns.transpose() * solver.solve(columns);
  return std::clamp((factor.information * covariance).trace() / size_, 1e-6, 1.0);
}

// By scan, how many links hold it about as well as each other: a weak one beside a strong one does not count.
std::vector<double> PoseEquations::links_by_scan(const Solver& solver) const {
  std::vector<double> sums(unknown_.size(), 0), squares(unknown_.size(), 0);
  for (const RelativeFactor& factor : shared_) {
    const double share = share_of(factor, solver);
    for (const std::size_t scan : {factor.source, factor.target}) {
      sums[scan] += share;
      squares[scan] += share * share;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = squares[i] > 0 ? sums[i] / squares[i] : 1;
  return sums;
}

std::optional<std::vector<Vector6>> PoseEquations::solve() const {
  std::vector<Vector6> steps(unknown_.size(), Vector6::Zero());
  if (unknowns_ == 0) return steps;
  const Solver solver(matrix_of(information_));
  if (!is_positive(solver)) return {};
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
  const Solver solver(matrix_of(information_));
  if (!is_positive(solver)) return blocks;
  Entries entries = scatter_;
  const std::vector<double> links = links_by_scan(solver);
  for (const RelativeFactor& factor : shared_) {
    add_between(factor, std::max(links[factor.source], links[factor.target]) * *factor.scatter, entries);
  }
  const Eigen::SparseMatrix<double> scatter = matrix_of(entries);
  for (std::size_t i = 0; i < unknown_.size(); ++i) {
    if (unknown_[i] == stays) continue;
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(size_ * unknowns_, size_);
    unit.middleRows(size_ * unknown_[i], size_).setIdentity();
    const Eigen::MatrixXd columns = solver.solve(unit);
    blocks[i].bottomRightCorner(size_, size_) = columns.transpose() * (scatter * columns);
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
