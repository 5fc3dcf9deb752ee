// Prints random assignment problems with the solver's answers, for assignment_scipy_test.py to check. A problem is
// "sources targets edges threshold energy", its edges "source target cost", and the target of every source.

#include <fmt/core.h>

#include "matching/assignment_oracles.hpp"

int main() {
  constexpr std::size_t problems = 200;
  fmt::print("{}\n", problems);
  for (std::size_t seed = 0; seed < problems; ++seed) {
    const std::size_t sources = seed * 7 % 120, targets = seed * 11 % 120;
    const double edges_per_source = 1.0 + static_cast<double>(seed % 40);
    const std::int64_t units_per_bit = seed % 2 == 0 ? 1 : 1000;
    const igsp::AssignmentProblem problem =
        igsp::random_problem(sources, targets, edges_per_source, units_per_bit, seed);
    const igsp::Assignment answer = igsp::solve(problem);
    fmt::print("{} {} {} {} {}\n", sources, targets, problem.edges.size(), problem.threshold, answer.energy);
    for (const igsp::AssignmentEdge& edge : problem.edges) {
      fmt::print("{} {} {}\n", edge.source, edge.target, edge.cost);
    }
    for (const std::int32_t target : answer.target_of_source) fmt::print("{} ", target);
    fmt::print("\n");
  }
}
