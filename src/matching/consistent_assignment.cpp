#include "matching/consistent_assignment.hpp"

#include <algorithm>
#include <numeric>

#include "matching/assignment.hpp"

namespace igsp {
namespace {

// The graph of one motion is nearly a clique, whose eigenvector stands out after a few multiplications.
constexpr int multiplications = 8;
constexpr double threshold_bits = 100.0;  // T_cd: the costs are shares of it, so any number would do

}  // namespace

std::vector<double> consistency_weights(const ConsistencyGraph& graph) {
  std::vector<double> weights(graph.size(), 1.0), next(graph.size());
  for (int k = 0; k < multiplications; ++k) {
    double largest = 0;
    for (std::size_t c = 0; c < graph.size(); ++c) {
      double sum = 0;
      graph.visit_neighbours(c, [&](std::size_t neighbour) { sum += weights[neighbour]; });
      next[c] = sum;
      largest = std::max(largest, sum);
    }
    if (largest > 0) std::transform(next.begin(), next.end(), next.begin(), [&](double w) { return w / largest; });
    weights.swap(next);
  }
  return weights;
}

std::vector<std::uint32_t> consistent_assignment(std::span<const Candidate> candidates, std::span<const double> weights,
                                                 std::size_t sources, std::size_t targets) {
  const std::int64_t threshold = to_assignment_units(threshold_bits);
  std::vector<std::uint32_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Candidate &x = candidates[a], &y = candidates[b];
    return x.source != y.source ? x.source < y.source : x.target < y.target;
  });
  std::vector<AssignmentEdge> edges;
  for (const std::uint32_t c : order) {
    const std::int64_t cost = to_assignment_units(threshold_bits * (1 - weights[c]));
    if (cost < threshold) edges.push_back({candidates[c].source, candidates[c].target, cost});
  }
  const Assignment assignment = solve_assignment(sources, targets, edges, threshold);
  std::vector<std::uint32_t> matched;
  for (std::uint32_t c = 0; c < candidates.size(); ++c) {
    const auto target = static_cast<std::int32_t>(candidates[c].target);
    if (assignment.target_of_source[candidates[c].source] == target) matched.push_back(c);
  }
  return matched;
}

}  // namespace igsp
