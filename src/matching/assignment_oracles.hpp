#pragma once

// Other ways to the optimum of an assignment problem, for tests and benchmarks only.

#define LEMON_ONLY_TEMPLATES  // its headers are all that is needed
#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "matching/assignment.hpp"

namespace igsp {

struct AssignmentProblem {
  std::size_t sources = 0;
  std::size_t targets = 0;
  std::vector<AssignmentEdge> edges;
  std::int64_t threshold = 0;
};

inline Assignment solve(const AssignmentProblem& problem) {
  return solve_assignment(problem.sources, problem.targets, problem.edges, problem.threshold);
}

/// Costs like Hamming distances in the lower tail of all pairs: integers that gather below the threshold of 95 bits.
inline AssignmentProblem random_problem(std::size_t sources, std::size_t targets, double edges_per_source,
                                        std::int64_t units_per_bit, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  AssignmentProblem problem{sources, targets, {}, 95 * units_per_bit};
  const double density = targets == 0 ? 1.0 : std::min(1.0, edges_per_source / static_cast<double>(targets));
  const bool sparse = density < 1.0;
  std::geometric_distribution<std::size_t> geometric(sparse ? density : 0.5);  // must lie inside (0, 1)
  const auto skip = [&]() -> std::size_t { return sparse ? geometric(random) : 0; };
  std::exponential_distribution<double> below_threshold(1.0 / 6.0);
  for (std::size_t i = 0; i < sources; ++i) {
    for (std::size_t j = skip(); j < targets; j += 1 + skip()) {
      const std::int64_t bits = 94 - static_cast<std::int64_t>(below_threshold(random));
      problem.edges.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j),
                               std::max<std::int64_t>(0, bits) * units_per_bit});
    }
  }
  return problem;
}

/// The matrix of Eq. 5: max(m, n) rows and columns, the threshold wherever there is no edge; row-major.
inline std::vector<std::int64_t> padded_matrix(const AssignmentProblem& problem) {
  const std::size_t size = std::max(problem.sources, problem.targets);
  std::vector<std::int64_t> matrix(size * size, problem.threshold);
  for (const AssignmentEdge& edge : problem.edges) matrix[edge.source * size + edge.target] = edge.cost;
  return matrix;
}

/// Least cost of a perfect matching of a square matrix, by the dense O(n^3) Kuhn-Munkres method: rows enter one by one,
/// and an alternating tree over all columns grows by the least slack until it reaches a free column.
inline std::int64_t kuhn_munkres(std::size_t size, const std::vector<std::int64_t>& cost) {
  constexpr std::int64_t infinite = std::numeric_limits<std::int64_t>::max();
  const std::size_t root = size;  // a column beyond the matrix, which holds the entering row
  std::vector<std::int64_t> row_label(size, 0), column_label(size, 0);
  std::vector<std::size_t> row_of(size + 1, size), parent(size);
  for (std::size_t entering = 0; entering < size; ++entering) {
    std::vector<std::int64_t> slack(size, infinite);
    std::vector<bool> in_tree(size + 1, false);
    std::size_t column = root;
    row_of[root] = entering;
    do {
      in_tree[column] = true;
      const std::size_t row = row_of[column];
      std::size_t nearest = root;
      for (std::size_t j = 0; j < size; ++j) {
        if (in_tree[j]) continue;
        const std::int64_t reduced = cost[row * size + j] - row_label[row] - column_label[j];
        if (reduced < slack[j]) {
          slack[j] = reduced;
          parent[j] = column;
        }
        if (nearest == root || slack[j] < slack[nearest]) nearest = j;
      }
      const std::int64_t step = slack[nearest];
      row_label[entering] += step;
      for (std::size_t j = 0; j < size; ++j) {
        if (in_tree[j]) {
          column_label[j] -= step;
          row_label[row_of[j]] += step;
        } else {
          slack[j] -= step;
        }
      }
      column = nearest;
    } while (row_of[column] != size);
    for (; column != root; column = parent[column]) row_of[column] = row_of[parent[column]];
  }
  std::int64_t total = 0;
  for (std::size_t j = 0; j < size; ++j) total += cost[row_of[j] * size + j];
  return total;
}

/// The problem as a flow: a unit leaves every source, along an edge or for the dummy at the cost `threshold`; a target
/// takes one at most.
class LemonNetworkSimplex {
 public:
  explicit LemonNetworkSimplex(const AssignmentProblem& problem)
      : cost_(graph_), supply_(graph_), simplex_(build(problem)) {
    simplex_.costMap(cost_).supplyMap(supply_);
  }

  /// The least energy, or -1 if it finds none.
  std::int64_t energy() {
    return simplex_.run() == Simplex::OPTIMAL ? simplex_.template totalCost<std::int64_t>() : -1;
  }

 private:
  using Graph = lemon::SmartDigraph;
  using Simplex = lemon::NetworkSimplex<Graph, int, std::int64_t>;

  const Graph& build(const AssignmentProblem& problem) {
    const std::size_t dummy = problem.sources + problem.targets;
    graph_.reserveNode(static_cast<int>(dummy + 1));
    graph_.reserveArc(static_cast<int>(problem.edges.size() + problem.sources));
    for (std::size_t node = 0; node <= dummy; ++node) graph_.addNode();
    const auto connect = [&](std::size_t from, std::size_t to, std::int64_t cost) {
      cost_[graph_.addArc(Graph::nodeFromId(static_cast<int>(from)), Graph::nodeFromId(static_cast<int>(to)))] = cost;
    };
    for (const AssignmentEdge& edge : problem.edges) connect(edge.source, problem.sources + edge.target, edge.cost);
    for (std::size_t i = 0; i < problem.sources; ++i) connect(i, dummy, problem.threshold);
    for (std::size_t node = 0; node < dummy; ++node) {
      supply_[Graph::nodeFromId(static_cast<int>(node))] = node < problem.sources ? 1 : -1;
    }
    supply_[Graph::nodeFromId(static_cast<int>(dummy))] = -static_cast<int>(problem.sources);
    return graph_;
  }

  Graph graph_;
  Graph::ArcMap<std::int64_t> cost_;
  Graph::NodeMap<int> supply_;
  Simplex simplex_;
};

}  // namespace igsp
