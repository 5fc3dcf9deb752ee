// The exact assignment beside LEMON's network simplex on the same graphs, and beside dense Kuhn-Munkres on the padded
// matrix of Eq. 5. Graphs are built outside the timed part; ours includes checking and sorting the edges.

#include <benchmark/benchmark.h>

#include <algorithm>

#include "matching/assignment_oracles.hpp"
#include "matching/hamming.hpp"

namespace {

using igsp::AssignmentProblem;

enum Kind { independent_costs, similar_descriptors };

/// Descriptors that differ from a mix of two of 40 prototypes by noise of three strengths: some keypoints have many
/// look-alikes, some none. The threshold is the one that leaves about `edges_per_source` edges.
AssignmentProblem descriptor_problem(std::size_t sources, std::size_t targets, double edges_per_source) {
  std::mt19937_64 random(1);
  std::vector<igsp::Descriptor> prototypes(40), descriptors(sources + targets);
  for (igsp::Descriptor& prototype : prototypes) {
    for (std::uint64_t& word : prototype) word = random() & random();
  }
  for (igsp::Descriptor& descriptor : descriptors) {
    const igsp::Descriptor &a = prototypes[random() % 40], &b = prototypes[random() % 40];
    const std::uint64_t strength = random() % 3;
    for (int w = 0; w < igsp::bsc_words; ++w) {
      const std::uint64_t mask = random(), first = random(), second = random(), third = random(), fourth = random();
      const std::uint64_t noise = first & second & (strength > 0 ? third : ~0ull) & (strength > 1 ? fourth : ~0ull);
      descriptor[w] = ((a[w] & mask) | (b[w] & ~mask)) ^ noise;
    }
  }
  const std::span all(descriptors);
  const igsp::FeatureDistanceHistogram histogram =
      igsp::feature_distance_histogram(all.first(sources), 1, all.last(targets), 1);
  const double wanted = edges_per_source * static_cast<double>(sources);
  std::int64_t threshold = 0;
  for (double below = 0; below + static_cast<double>(histogram[threshold]) <= wanted; ++threshold) {
    below += static_cast<double>(histogram[threshold]);
  }
  AssignmentProblem problem{sources, targets, {}, threshold * igsp::assignment_units_per_bit};
  for (const igsp::FeaturePair& pair :
       igsp::feature_pairs_below(all.first(sources), 1, all.last(targets), static_cast<double>(threshold), 1)) {
    problem.edges.push_back({pair.source, pair.target, pair.distance * igsp::assignment_units_per_bit});
  }
  return problem;
}

/// Arguments: sources, targets, edges per source, kind.
AssignmentProblem problem_of(const benchmark::State& state) {
  const auto sources = static_cast<std::size_t>(state.range(0)), targets = static_cast<std::size_t>(state.range(1));
  const auto edges_per_source = static_cast<double>(state.range(2));
  return state.range(3) == independent_costs
             ? igsp::random_problem(sources, targets, edges_per_source, igsp::assignment_units_per_bit, 1)
             : descriptor_problem(sources, targets, edges_per_source);
}

void report(benchmark::State& state, const AssignmentProblem& problem, std::int64_t energy) {
  state.counters["edges"] = static_cast<double>(problem.edges.size());
  state.counters["energy_bits"] = igsp::bits_from_assignment_units(energy);
}

void ours(benchmark::State& state) {
  const AssignmentProblem problem = problem_of(state);
  igsp::Assignment answer;
  for (auto _ : state) benchmark::DoNotOptimize(answer = igsp::solve(problem));
  report(state, problem, answer.energy);
  if (!igsp::certificate_holds(problem.sources, problem.targets, problem.edges, problem.threshold, answer)) {
    state.SkipWithError("the certificate does not hold");
  }
}

void lemon_network_simplex(benchmark::State& state) {
  const AssignmentProblem problem = problem_of(state);
  igsp::LemonNetworkSimplex simplex(problem);
  std::int64_t energy = 0;
  for (auto _ : state) benchmark::DoNotOptimize(energy = simplex.energy());
  report(state, problem, energy);
  if (energy != igsp::solve(problem).energy) state.SkipWithError("LEMON's energy differs");
}

void kuhn_munkres_padded(benchmark::State& state) {
  const AssignmentProblem problem = problem_of(state);
  const std::size_t size = std::max(problem.sources, problem.targets);
  const std::vector<std::int64_t> matrix = igsp::padded_matrix(problem);
  std::int64_t cost = 0;
  for (auto _ : state) benchmark::DoNotOptimize(cost = igsp::kuhn_munkres(size, matrix));
  const std::int64_t energy = cost - static_cast<std::int64_t>(size - problem.sources) * problem.threshold;
  report(state, problem, energy);
  if (energy != igsp::solve(problem).energy) state.SkipWithError("the energy on the padded matrix differs");
}

void graphs(benchmark::internal::Benchmark* b) {
  b->ArgNames({"sources", "targets", "edges_per_source", "kind"})->Unit(benchmark::kMillisecond)->Repetitions(5);
  for (const int kind : {independent_costs, similar_descriptors}) {
    b->Args({2000, 2000, 93, kind})->Args({2000, 1500, 93, kind});
    b->Args({20000, 20000, 100, kind})->Args({20000, 15000, 100, kind});
  }
}

void growing_dense(benchmark::internal::Benchmark* b) {
  b->ArgNames({"sources", "targets", "edges_per_source", "kind"})->Unit(benchmark::kMillisecond)->Repetitions(3);
  for (const int size : {500, 1000, 2000}) b->Args({size, size, 93, independent_costs});
}

BENCHMARK(ours)->Apply(graphs)->ReportAggregatesOnly();
BENCHMARK(lemon_network_simplex)->Apply(graphs)->ReportAggregatesOnly();
BENCHMARK(ours)->Apply(growing_dense)->ReportAggregatesOnly();
BENCHMARK(kuhn_munkres_padded)->Apply(growing_dense)->ReportAggregatesOnly();

}  // namespace
