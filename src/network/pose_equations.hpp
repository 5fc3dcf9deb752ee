#pragma once

#include <Eigen/SparseCholesky>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "network/small_motion.hpp"

namespace igsp {

/// What holds two scans together, as a quadratic in the small step about `centre`, in the target's frame, that moves
/// the source: step^T information step / 2 + gradient^T step.
struct RelativeFactor {
  std::size_t source = 0, target = 0;
  Transformation target_from_source = Transformation::Identity();  ///< where the quadratic was taken
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  /// Covariance of the gradient, of errors that the source or the target has in all its links; none: as large as the
  /// information, and independent of other links.
  std::optional<Matrix6> scatter = {};
};

/// What holds a scan where it is known to lie, as a quadratic in its own step.
struct PriorFactor {
  std::size_t scan = 0;
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
};

/// Normal equations of the poses of many scans: a step of each about its own centre, in its own frame. Scans outside
/// `is_free` stay where they are. With 4 degrees of freedom scans turn about z alone.
class PoseEquations {
 public:
  PoseEquations(std::span<const Eigen::Vector3d> centres, const std::vector<bool>& is_free, int degrees_of_freedom);

  void add(const RelativeFactor& factor);
  void add(const PriorFactor& factor);

  /// One step per scan, 0 for those that stay; nothing where the equations do not determine them.
  std::optional<std::vector<Vector6>> solve() const;

  /// Of every scan's step, 0 for those that stay or where the equations do not determine them: A^-1 B A^-1 with the
  /// information A of all factors and the scatter B of their gradients. That of a link whose errors others share grows
  /// as if it alone held its scans together: what is wrong in a scan no second link averages out.
  std::vector<Matrix6> covariances() const;

 private:
  static constexpr std::size_t stays = SIZE_MAX;
  using Entries = std::vector<Eigen::Triplet<double>>;
  using Solver = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

  void add_block(std::size_t row, std::size_t column, const Matrix6& block, Entries& entries) const;
  void add_between(const RelativeFactor& factor, const Matrix6& block, Entries& entries) const;
  double share_of(const RelativeFactor& factor, const Solver& solver) const;
  std::vector<double> links_by_scan(const Solver& solver) const;
  Eigen::SparseMatrix<double> matrix_of(const Entries& entries) const;

  std::span<const Eigen::Vector3d> centres_;
  int size_;                          // of a step: its last entries
  std::vector<std::size_t> unknown_;  // place among the unknowns
  std::size_t unknowns_ = 0;
  Entries information_, scatter_;       // without that of `shared_`
  std::vector<RelativeFactor> shared_;  // factors with a scatter of their own
  Eigen::VectorXd gradient_;
};

/// Moves every scan by its step; returns the largest component of a step.
double apply_steps(std::span<const Vector6> steps, std::span<const Eigen::Vector3d> centres,
                   std::vector<Transformation>& world_from_scan);

}  // namespace igsp
