#pragma once

#include <cstdint>
#include <vector>

#include "matching/energy.hpp"

namespace igsp::paper {

/// What an iteration costs on the same input: the exact sparse assignment, and the paper's own way, the padded matrix
/// of Eq. 5 and Kuhn-Munkres on it. CPU seconds.
struct AssignmentCost {
  std::size_t edges = 0;
  double edges_s = 0, sparse_s = 0;  ///< candidate edges, assignment over them
  double matrix_s = 0, dense_s = 0;  ///< M_ed, M_cd and M_bg; Kuhn-Munkres
  double energy = 0;                 ///< least sum of CD + T_cd per unmatched source [bits]
};

/// Row-major FD of all pairs: M_fd of Algorithm 1, part of its preparation.
using FeatureDistances = std::vector<std::uint16_t>;

/// `keypoints` with the source moved by the transformation so far. Without `dense` the matrix is not built. Throws
/// std::logic_error when the two energies are not equal to the last unit.
AssignmentCost assignment_cost(const KeypointSets& keypoints, const FeatureDistances& feature_distances,
                               double ed_scale, const EnergyWeights& weights, double threshold, bool dense);

}  // namespace igsp::paper
