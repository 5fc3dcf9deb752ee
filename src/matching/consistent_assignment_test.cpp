#include "matching/consistent_assignment.hpp"

#include <gtest/gtest.h>

namespace igsp {
namespace {

ConsistencyGraph graph_of(std::size_t size, const std::vector<std::pair<int, int>>& edges) {
  ConsistencyGraph graph(size);
  for (const auto& [a, b] : edges) {
    graph.row(a)[b / 64] |= std::uint64_t{1} << (b % 64);
    graph.row(b)[a / 64] |= std::uint64_t{1} << (a % 64);
  }
  return graph;
}

Candidate candidate(std::uint32_t source, std::uint32_t target) {
  return {source, target, 0.0f, Eigen::Quaternionf::Identity()};
}

// Four that all agree, two that agree with each other alone, one that agrees with nobody.
const ConsistencyGraph clique_and_pair = graph_of(7, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}, {4, 5}});

TEST(ConsistencyWeights, AreLargestInTheLargestClique) {
  const std::vector<double> weights = consistency_weights(clique_and_pair);
  for (int c = 0; c < 4; ++c) EXPECT_DOUBLE_EQ(weights[c], 1.0);
  for (int c = 4; c < 6; ++c) EXPECT_LT(weights[c], 0.01);  // (1 / 3)^8
  EXPECT_EQ(weights[6], 0.0);
}

TEST(ConsistencyWeights, AreZeroWhereNothingAgrees) {
  EXPECT_TRUE(consistency_weights(ConsistencyGraph(0)).empty());
  for (const double weight : consistency_weights(ConsistencyGraph(70))) EXPECT_EQ(weight, 0.0);
}

TEST(ConsistentAssignment, IsOneToOneAndPrefersSupport) {
  // Candidates 1 and 4 want the same target, 2 and 5 the same source: the clique wins both, 6 has no support at all.
  const std::vector<Candidate> candidates{candidate(0, 0), candidate(1, 1), candidate(2, 2), candidate(3, 3),
                                          candidate(4, 1), candidate(2, 4), candidate(5, 5)};
  const auto matched = consistent_assignment(candidates, consistency_weights(clique_and_pair), 6, 6);
  EXPECT_EQ(matched, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(ConsistentAssignment, TakesTwoWeakOnesForOneStronger) {
  // 0.6 + 0.6 > 1: the optimum of the sum, not the greedy choice.
  const std::vector<Candidate> candidates{candidate(0, 0), candidate(0, 1), candidate(1, 0)};
  const std::vector<double> weights{1.0, 0.6, 0.6};
  EXPECT_EQ(consistent_assignment(candidates, weights, 2, 2), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_TRUE(consistent_assignment({}, {}, 0, 0).empty());
}

}  // namespace
}  // namespace igsp
