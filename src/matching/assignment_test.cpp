#include "matching/assignment.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <ostream>

#include "igsp/errors.hpp"
#include "matching/assignment_oracles.hpp"

namespace igsp {

void showValue(const AssignmentProblem& problem, std::ostream& out) {
  out << problem.sources << " x " << problem.targets << ", threshold " << problem.threshold << ":";
  for (const AssignmentEdge& e : problem.edges) out << " (" << e.source << ", " << e.target << ": " << e.cost << ")";
}

namespace {

/// Tries every matching: least[set] is the least energy of the sources so far that take the targets of `set`.
std::int64_t brute_force_energy(const AssignmentProblem& problem) {
  constexpr std::int64_t impossible = -1;
  std::vector<std::int64_t> least(std::size_t{1} << problem.targets, impossible);
  least[0] = 0;
  const auto improve = [](std::int64_t& value, std::int64_t candidate) {
    if (value == impossible || candidate < value) value = candidate;
  };
  for (std::size_t i = 0; i < problem.sources; ++i) {
    std::vector<std::int64_t> next(least.size(), impossible);
    for (std::size_t set = 0; set < least.size(); ++set) {
      if (least[set] == impossible) continue;
      improve(next[set], least[set] + problem.threshold);
      for (const AssignmentEdge& edge : problem.edges) {
        const std::size_t bit = std::size_t{1} << edge.target;
        if (edge.source == i && (set & bit) == 0) improve(next[set | bit], least[set] + edge.cost);
      }
    }
    least = next;
  }
  std::int64_t energy = impossible;
  for (const std::int64_t value : least) {
    if (value != impossible) improve(energy, value);
  }
  return energy;
}

bool certified(const AssignmentProblem& problem, const Assignment& assignment) {
  return certificate_holds(problem.sources, problem.targets, problem.edges, problem.threshold, assignment);
}

/// Up to 7 x 7; a small range of costs makes ties, a threshold below it leaves pairs without an edge.
rc::Gen<AssignmentProblem> small_problem() {
  return rc::gen::exec([] {
    AssignmentProblem problem;
    problem.sources = *rc::gen::inRange<std::size_t>(0, 8);
    problem.targets = *rc::gen::inRange<std::size_t>(0, 8);
    const auto range = *rc::gen::element<std::int64_t>(1, 2, 3, 6, 50, 100'000);
    problem.threshold = *rc::gen::inRange<std::int64_t>(0, range + 1);
    const auto costs = *rc::gen::container<std::vector<std::int64_t>>(problem.sources * problem.targets,
                                                                      rc::gen::inRange<std::int64_t>(0, range));
    for (std::uint32_t k = 0; k < costs.size(); ++k) {
      const auto targets = static_cast<std::uint32_t>(problem.targets);
      if (costs[k] < problem.threshold) problem.edges.push_back({k / targets, k % targets, costs[k]});
    }
    return problem;
  });
}

AssignmentProblem scaled(AssignmentProblem problem, std::int64_t factor) {
  problem.threshold *= factor;
  for (AssignmentEdge& edge : problem.edges) edge.cost *= factor;
  return problem;
}

/// 100 times 30 problems; rapidcheck shrinks the one that fails.
template <typename Law>
bool for_small_problems(const char* name, const Law& law) {
  return rc::check(name, [&law] {
    const auto problems = *rc::gen::container<std::vector<AssignmentProblem>>(30, small_problem());
    for (const AssignmentProblem& problem : problems) law(problem);
  });
}

TEST(Assignment, EqualsBruteForceAndProvesIt) {
  EXPECT_TRUE(for_small_problems("optimal", [](const AssignmentProblem& problem) {
    const Assignment assignment = solve(problem);
    RC_ASSERT(assignment.energy == brute_force_energy(problem));
    RC_ASSERT(certified(problem, assignment));
  }));
}

TEST(Assignment, EqualsKuhnMunkresOnThePaddedMatrix) {
  // Eq. 5 also charges the threshold for the rows that the padding adds.
  EXPECT_TRUE(for_small_problems("padded", [](const AssignmentProblem& problem) {
    const std::size_t size = std::max(problem.sources, problem.targets);
    const std::int64_t padding = problem.threshold * static_cast<std::int64_t>(size - problem.sources);
    RC_ASSERT(kuhn_munkres(size, padded_matrix(problem)) == solve(problem).energy + padding);
  }));
}

TEST(Assignment, ExchangingTheSidesExchangesOnlyTheUnmatched) {
  EXPECT_TRUE(for_small_problems("exchange", [](const AssignmentProblem& problem) {
    AssignmentProblem exchanged{problem.targets, problem.sources, {}, problem.threshold};
    for (const AssignmentEdge& e : problem.edges) exchanged.edges.push_back({e.target, e.source, e.cost});
    std::sort(exchanged.edges.begin(), exchanged.edges.end(), [](const AssignmentEdge& a, const AssignmentEdge& b) {
      return a.source < b.source || (a.source == b.source && a.target < b.target);
    });
    const auto difference = static_cast<std::int64_t>(problem.sources) - static_cast<std::int64_t>(problem.targets);
    RC_ASSERT(solve(problem).energy == solve(exchanged).energy + problem.threshold * difference);
  }));
}

TEST(Assignment, CostsUpToTheLimitOf64BitsAreExact) {
  EXPECT_TRUE(for_small_problems("scaled", [](const AssignmentProblem& problem) {
    if (problem.threshold == 0) return;
    const std::int64_t limit = max_assignment_threshold(problem.sources, problem.targets);
    const AssignmentProblem large = scaled(problem, limit / problem.threshold);
    const Assignment assignment = solve(large);
    RC_ASSERT(assignment.energy == brute_force_energy(large));
    RC_ASSERT(certified(large, assignment));
  }));
}

struct Shape {
  std::size_t sources, targets;
  double edges_per_source;
};

TEST(Assignment, EqualsLemonAndKuhnMunkresOnLargerGraphs) {
  const Shape shapes[] = {{60, 60, 3},   {200, 200, 1}, {200, 200, 8},  {300, 300, 60}, {150, 250, 20}, {250, 150, 9},
                          {40, 300, 12}, {300, 40, 5},  {80, 80, 1000}, {1, 200, 30},   {200, 1, 1}};
  std::uint64_t seed = 0;
  for (const Shape& shape : shapes) {
    for (const std::int64_t units_per_bit : {std::int64_t{1}, assignment_units_per_bit}) {
      const AssignmentProblem problem =
          random_problem(shape.sources, shape.targets, shape.edges_per_source, units_per_bit, ++seed);
      const Assignment assignment = solve(problem);
      EXPECT_EQ(assignment.energy, LemonNetworkSimplex(problem).energy()) << "seed " << seed;
      EXPECT_TRUE(certified(problem, assignment)) << "seed " << seed;
      const std::size_t size = std::max(shape.sources, shape.targets);
      const auto padding = static_cast<std::int64_t>(size - shape.sources) * problem.threshold;
      EXPECT_EQ(assignment.energy + padding, kuhn_munkres(size, padded_matrix(problem))) << "seed " << seed;
    }
  }
}

TEST(Assignment, EqualsLemonWithoutTies) {
  for (const Shape& shape : {Shape{300, 300, 40}, Shape{300, 200, 40}, Shape{200, 300, 40}, Shape{200, 200, 400}}) {
    AssignmentProblem problem = random_problem(shape.sources, shape.targets, shape.edges_per_source, 1 << 20, 77);
    std::mt19937_64 random(3);
    for (AssignmentEdge& edge : problem.edges) edge.cost += static_cast<std::int64_t>(random() % (1 << 20));
    const Assignment assignment = solve(problem);
    EXPECT_EQ(assignment.energy, LemonNetworkSimplex(problem).energy());
    EXPECT_TRUE(certified(problem, assignment));
  }
}

TEST(Assignment, EmptyAndEdgelessProblems) {
  for (const auto& [sources, targets] : {std::pair<std::size_t, std::size_t>{0, 0}, {0, 5}, {5, 0}, {4, 3}}) {
    const AssignmentProblem problem{sources, targets, {}, 10};
    const Assignment assignment = solve(problem);
    EXPECT_EQ(assignment.target_of_source, std::vector<std::int32_t>(sources, -1));
    EXPECT_EQ(assignment.matches, 0u);
    EXPECT_EQ(assignment.energy, 10 * static_cast<std::int64_t>(sources));
    EXPECT_TRUE(certified(problem, assignment));
  }
}

TEST(Assignment, IsolatedNodesStayUnmatched) {
  const AssignmentProblem problem{5, 6, {{1, 4, 3}, {3, 4, 2}, {3, 5, 8}}, 10};
  const Assignment assignment = solve(problem);
  EXPECT_EQ(assignment.target_of_source, (std::vector<std::int32_t>{-1, 4, -1, 5, -1}));
  EXPECT_EQ(assignment.energy, 3 + 8 + 3 * 10);
  EXPECT_TRUE(certified(problem, assignment));
}

TEST(Assignment, LeastEnergyIsNotTheMostMatches) {
  // Matching both costs 9 + 9; leaving one unmatched 0 + 10.
  const AssignmentProblem problem{2, 2, {{0, 0, 9}, {1, 0, 0}, {1, 1, 9}}, 10};
  const Assignment assignment = solve(problem);
  EXPECT_EQ(assignment.target_of_source, (std::vector<std::int32_t>{-1, 0}));
  EXPECT_EQ(assignment.energy, 10);
}

TEST(Assignment, EqualCostsGiveAMaximumMatching) {
  for (const std::int64_t cost : {0, 5, 9}) {  // 9: the dearest edge that is still worth taking
    AssignmentProblem problem{40, 30, {}, 10};
    for (std::uint32_t k = 0; k < 40 * 30; ++k) problem.edges.push_back({k / 30, k % 30, cost});
    const Assignment assignment = solve(problem);
    EXPECT_EQ(assignment.matches, 30u);
    EXPECT_EQ(assignment.energy, 30 * cost + 10 * 10);
    EXPECT_TRUE(certified(problem, assignment));
  }
}

TEST(Assignment, LongAugmentingPath) {
  // A chain in which the last source can only be matched if every other source moves on to its second target.
  constexpr std::uint32_t length = 50'000;
  AssignmentProblem problem{length + 1, length + 1, {}, 100};
  for (std::uint32_t i = 0; i < length; ++i) {
    problem.edges.push_back({i, i, 1});
    problem.edges.push_back({i, i + 1, 1});
  }
  problem.edges.push_back({length, 0, 1});
  const Assignment assignment = solve(problem);
  EXPECT_EQ(assignment.matches, length + 1u);
  EXPECT_TRUE(certified(problem, assignment));
}

TEST(Assignment, SameInputSameAnswer) {
  const AssignmentProblem problem = random_problem(300, 280, 25, 1, 5);
  const Assignment first = solve(problem), second = solve(problem);
  EXPECT_EQ(first.target_of_source, second.target_of_source);
  EXPECT_EQ(first.source_potentials, second.source_potentials);
  EXPECT_EQ(first.target_potentials, second.target_potentials);
}

TEST(Assignment, RejectsWhatItCannotTake) {
  using Edges = std::vector<AssignmentEdge>;
  EXPECT_THROW(solve_assignment(2, 2, Edges{{1, 0, 1}, {0, 0, 1}}, 5), InvalidArgument);  // order of sources
  EXPECT_THROW(solve_assignment(2, 2, Edges{{0, 1, 1}, {0, 0, 1}}, 5), InvalidArgument);  // order of targets
  EXPECT_THROW(solve_assignment(2, 2, Edges{{0, 1, 1}, {0, 1, 2}}, 5), InvalidArgument);  // twice
  EXPECT_THROW(solve_assignment(2, 2, Edges{{2, 0, 1}}, 5), InvalidArgument);
  EXPECT_THROW(solve_assignment(2, 2, Edges{{0, 2, 1}}, 5), InvalidArgument);
  EXPECT_THROW(solve_assignment(2, 2, Edges{{0, 0, 5}}, 5), InvalidArgument);
  EXPECT_THROW(solve_assignment(2, 2, Edges{{0, 0, -1}}, 5), InvalidArgument);
  EXPECT_THROW(solve_assignment(2, 2, {}, -1), InvalidArgument);
  EXPECT_THROW(solve_assignment(2, 2, {}, max_assignment_threshold(2, 2) + 1), InvalidArgument);
  EXPECT_THROW(solve_assignment(std::size_t{1} << 31, 2, {}, 5), InvalidArgument);
  EXPECT_THROW(certificate_holds(2, 2, Edges{{0, 0, 5}}, 5, {}), InvalidArgument);
  EXPECT_NO_THROW(solve_assignment(2, 2, Edges{{0, 0, 4}}, 5));
}

class TamperedCertificate : public testing::Test {
 protected:
  const AssignmentProblem problem_ = random_problem(60, 50, 8, 4, 9);
  Assignment answer_ = solve(problem_);
};

TEST_F(TamperedCertificate, HoldsBefore) {
  ASSERT_GT(answer_.matches, 10u);
  EXPECT_TRUE(certified(problem_, answer_));
}

TEST_F(TamperedCertificate, FailsForEveryPotentialOffByOne) {
  for (std::vector<std::int64_t>* potentials : {&answer_.source_potentials, &answer_.target_potentials}) {
    for (std::int64_t& potential : *potentials) {
      for (const int change : {-1, 1}) {
        potential += change;
        EXPECT_FALSE(certified(problem_, answer_));
        potential -= change;
      }
    }
  }
}

TEST_F(TamperedCertificate, FailsForPotentialsMovedFromOneNodeToAnother) {
  std::vector<std::int64_t>& u = answer_.source_potentials;
  const auto largest = std::max_element(u.begin(), u.end());
  *largest += 1;  // beyond the threshold, while the sum stays
  *std::min_element(u.begin(), u.end()) -= 1;
  EXPECT_FALSE(certified(problem_, answer_));
}

TEST_F(TamperedCertificate, FailsForEveryMatchDropped) {
  for (std::size_t i = 0; i < problem_.sources; ++i) {
    if (answer_.target_of_source[i] == -1) continue;
    Assignment dropped = answer_;
    dropped.target_of_source[i] = -1;
    EXPECT_FALSE(certified(problem_, dropped));
    dropped.matches -= 1;
    dropped.energy += 1;
    EXPECT_FALSE(certified(problem_, dropped));
  }
}

TEST_F(TamperedCertificate, FailsForAWorseMatchingWithItsTrueEnergy) {
  Assignment nothing = answer_;
  nothing.target_of_source.assign(problem_.sources, -1);
  nothing.matches = 0;
  nothing.energy = problem_.threshold * static_cast<std::int64_t>(problem_.sources);
  EXPECT_FALSE(certified(problem_, nothing));
  // Potentials that add up to this energy are not feasible, or the energy would be the least.
  nothing.source_potentials.assign(problem_.sources, problem_.threshold);
  nothing.target_potentials.assign(problem_.targets, 0);
  EXPECT_FALSE(certified(problem_, nothing));
}

TEST_F(TamperedCertificate, FailsForWrongTargets) {
  const auto matched = std::find_if(answer_.target_of_source.begin(), answer_.target_of_source.end(),
                                    [](std::int32_t target) { return target != -1; });
  const auto other = std::find_if(matched + 1, answer_.target_of_source.end(), [](std::int32_t t) { return t != -1; });
  const std::int32_t right = *matched;
  for (const std::int32_t wrong : {*other, 50, -2}) {  // taken by another source, beyond the targets, no target at all
    *matched = wrong;
    EXPECT_FALSE(certified(problem_, answer_)) << wrong;
  }
  *matched = right;
  std::swap(*matched, *other);
  EXPECT_FALSE(certified(problem_, answer_));
}

// Sums, potentials and edges are all in order: less than the optimum, 3 + 10, which only one source reaches.
TEST(Certificate, FailsForATargetThatTwoSourcesShare) {
  const AssignmentProblem problem{2, 1, {{0, 0, 3}, {1, 0, 3}}, 10};
  EXPECT_FALSE(certified(problem, {{0, 0}, 2, 6, {3, 3}, {0}}));
  EXPECT_TRUE(certified(problem, {{0, -1}, 1, 13, {10, 10}, {-7}}));
}

TEST_F(TamperedCertificate, FailsForWrongTotalsAndSizes) {
  Assignment wrong = answer_;
  wrong.energy -= 1;
  EXPECT_FALSE(certified(problem_, wrong));
  wrong = answer_;
  wrong.matches += 1;
  EXPECT_FALSE(certified(problem_, wrong));
  wrong = answer_;
  wrong.target_of_source.pop_back();
  EXPECT_FALSE(certified(problem_, wrong));
  wrong = answer_;
  wrong.source_potentials.push_back(0);
  EXPECT_FALSE(certified(problem_, wrong));
  wrong = answer_;
  wrong.target_potentials.clear();
  EXPECT_FALSE(certified(problem_, wrong));
}

TEST(AssignmentUnits, RoundTrip) {
  EXPECT_EQ(to_assignment_units(3.0), 3 * assignment_units_per_bit);
  EXPECT_EQ(to_assignment_units(0.5 / static_cast<double>(assignment_units_per_bit)), 1);
  EXPECT_EQ(bits_from_assignment_units(to_assignment_units(171.25)), 171.25);
}

}  // namespace
}  // namespace igsp
