// Feature distances over all pairs at every instruction set that this machine has, one thread; `per_pair` is CPU time.

#include <benchmark/benchmark.h>

#include <random>
#include <string>

#include "matching/hamming.hpp"

namespace {

constexpr std::size_t keypoints = 5000, variants = 4;

std::vector<igsp::Descriptor> random_descriptors(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<igsp::Descriptor> descriptors(count);
  for (igsp::Descriptor& descriptor : descriptors) {
    for (std::uint64_t& word : descriptor) word = random();
  }
  return descriptors;
}

template <typename Pass>
void measure(benchmark::State& state, const Pass& pass) {
  const std::vector<igsp::Descriptor> sources = random_descriptors(keypoints * variants, 1);
  const std::vector<igsp::Descriptor> targets = random_descriptors(keypoints, 2);
  for (auto _ : state) pass(sources, targets);
  state.counters["per_pair"] = benchmark::Counter(
      keypoints * keypoints, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void rows(benchmark::State& state, igsp::SimdLevel level) {
  measure(state, [level](const auto& sources, const auto& targets) {
    igsp::feature_distance_rows(
        sources, variants, targets, 1,
        [](std::size_t, std::span<const std::uint16_t> distances) { benchmark::DoNotOptimize(distances.data()); },
        level);
  });
}

void histogram(benchmark::State& state) {
  measure(state, [](const auto& sources, const auto& targets) {
    benchmark::DoNotOptimize(igsp::feature_distance_histogram(sources, variants, targets, 1));
  });
}

void pairs_below(benchmark::State& state) {
  measure(state, [](const auto& sources, const auto& targets) {
    benchmark::DoNotOptimize(igsp::feature_pairs_below(sources, variants, targets, 194.0, 1));
  });
}

void on_demand(benchmark::State& state) {
  measure(state, [](const auto& sources, const auto& targets) {
    for (std::size_t i = 0; i < keypoints; ++i) {
      const std::span<const igsp::Descriptor> source(sources.data() + i * variants, variants);
      for (const igsp::Descriptor& target : targets) benchmark::DoNotOptimize(igsp::feature_distance(source, target));
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  const auto prepare = [](benchmark::internal::Benchmark* b) {
    b->Unit(benchmark::kMillisecond)->Repetitions(7)->ReportAggregatesOnly();
  };
  for (const igsp::SimdLevel level : igsp::available_simd_levels()) {
    prepare(benchmark::RegisterBenchmark(("rows/" + std::string(to_string(level))).c_str(), rows, level));
  }
  prepare(benchmark::RegisterBenchmark("histogram", histogram));
  prepare(benchmark::RegisterBenchmark("pairs_below", pairs_below));
  prepare(benchmark::RegisterBenchmark("on_demand", on_demand));
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
