#include "dense_assignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "matching/assignment_oracles.hpp"
#include "staged_loop.hpp"

namespace igsp::paper {
namespace {

// Eq. 5 from all pairs, not from our edges: so an edge that we miss is a difference in energy.
std::vector<std::int64_t> bipartite_matrix(const KeypointSets& keypoints, const FeatureDistances& feature_distances,
                                           double ed_scale, const EnergyWeights& weights, double threshold) {
  const std::size_t m = keypoints.source.size(), n = keypoints.target.size(), size = std::max(m, n);
  const std::int64_t limit = to_assignment_units(threshold);
  std::vector<std::int64_t> matrix(size * size, limit);
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double ed = ed_scale * (keypoints.source[i] - keypoints.target[j]).norm();
      const double cd = weights.fd * feature_distances[i * n + j] + weights.ed * ed;
      if (cd < threshold) matrix[i * size + j] = std::min(limit, to_assignment_units(cd));
    }
  }
  return matrix;
}

}  // namespace

AssignmentCost assignment_cost(const KeypointSets& keypoints, const FeatureDistances& feature_distances,
                               double ed_scale, const EnergyWeights& weights, double threshold, bool dense) {
  AssignmentCost cost;
  const std::int64_t limit = to_assignment_units(threshold);
  const double begin = cpu_seconds();
  const auto edges = candidate_edges(keypoints, ed_scale, weights, threshold, 1);
  const double with_edges = cpu_seconds();
  const Assignment sparse = solve_assignment(keypoints.source.size(), keypoints.target.size(), edges, limit);
  const double solved = cpu_seconds();
  cost.edges = edges.size();
  cost.edges_s = with_edges - begin;
  cost.sparse_s = solved - with_edges;
  cost.energy = bits_from_assignment_units(sparse.energy);
  if (!certificate_holds(keypoints.source.size(), keypoints.target.size(), edges, limit, sparse)) {
    throw std::logic_error("the certificate of the sparse assignment does not hold");
  }
  if (!dense) return cost;

  const double dense_begin = cpu_seconds();
  const auto matrix = bipartite_matrix(keypoints, feature_distances, ed_scale, weights, threshold);
  const double with_matrix = cpu_seconds();
  const std::size_t size = std::max(keypoints.source.size(), keypoints.target.size());
  const std::int64_t padded = kuhn_munkres(size, matrix);
  cost.dense_s = cpu_seconds() - with_matrix;
  cost.matrix_s = with_matrix - dense_begin;
  // A padding row costs T_cd whatever it takes.
  const std::int64_t energy = padded - static_cast<std::int64_t>(size - keypoints.source.size()) * limit;
  if (energy != sparse.energy) {
    throw std::logic_error(
        fmt::format("the padded dense assignment has the energy {}, the sparse one {} units", energy, sparse.energy));
  }
  return cost;
}

}  // namespace igsp::paper
