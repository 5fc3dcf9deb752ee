#include "matching/hamming.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>

#include "core/parallel.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

/// Sources come in runs of fixed length, so that what a run yields does not depend on how threads share the work.
constexpr std::size_t run_length = 32;

class FeatureRows {
 public:
  FeatureRows(std::span<const Descriptor> source_variants, std::size_t variants, std::span<const Descriptor> targets,
              SimdLevel level = best_simd_level())
      : source_variants_(source_variants), variants_(variants), targets_(targets), level_(level) {
    if (variants == 0 || source_variants.size() % variants != 0) {
      throw InvalidArgument("variants: " + std::to_string(variants) +
                            " per source, must be at least 1 and divide the " + std::to_string(source_variants.size()) +
                            " source descriptors");
    }
  }

  std::size_t sources() const { return source_variants_.size() / variants_; }
  std::size_t targets() const { return targets_.size(); }
  std::size_t runs() const { return (sources() + run_length - 1) / run_length; }

  /// Calls body(run, rows) for every run, in parallel; rows(visit) calls visit(source, distances) for its sources.
  template <typename Body>
  void for_each_run(int threads, const Body& body) const {
    parallel_blocks(runs(), threads, 1, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint16_t> distances(targets_.padded_size());
      for (std::size_t run = begin; run < end; ++run) {
        body(run, [&](const auto& visit) {
          const std::size_t end_source = std::min(sources(), (run + 1) * run_length);
          for (std::size_t source = run * run_length; source < end_source; ++source) {
            least_distances(source_variants_.subspan(source * variants_, variants_), targets_, level_, distances);
            visit(source, std::span<const std::uint16_t>(distances).first(targets_.size()));
          }
        });
      }
    });
  }

 private:
  std::span<const Descriptor> source_variants_;
  std::size_t variants_;
  TargetBlocks targets_;
  SimdLevel level_;
};

/// Four histograms in turn: equal distances follow each other often, and an increment then waits for the last one.
void add_to_histograms(std::span<const std::uint16_t> distances, std::array<FeatureDistanceHistogram, 4>& histograms) {
  for (std::size_t j = 0; j < distances.size(); ++j) ++histograms[j % 4][distances[j]];
}

void append_below(std::span<const std::uint16_t> distances, std::uint16_t limit, std::size_t source,
                  std::vector<FeaturePair>& pairs) {
  std::size_t size = pairs.size();
  const std::size_t below =
      std::count_if(distances.begin(), distances.end(), [&](std::uint16_t distance) { return distance < limit; });
  if (below == 0) return;
  pairs.resize(size + below + 1);                       // one to spare, since pairs that fail are written too
  for (std::size_t j = 0; j < distances.size(); ++j) {  // no branch: which pairs pass cannot be predicted
    pairs[size] = {static_cast<std::uint32_t>(source), static_cast<std::uint32_t>(j), distances[j]};
    size += distances[j] < limit;
  }
  pairs.resize(size);
}

}  // namespace

void feature_distance_rows(std::span<const Descriptor> source_variants, std::size_t variants,
                           std::span<const Descriptor> targets, int threads, const FeatureDistanceVisitor& visit,
                           SimdLevel level) {
  FeatureRows(source_variants, variants, targets, level).for_each_run(threads, [&](std::size_t, const auto& rows) {
    rows(visit);
  });
}

std::vector<std::uint16_t> feature_distance_matrix(std::span<const Descriptor> source_variants, std::size_t variants,
                                                   std::span<const Descriptor> targets, int threads) {
  const FeatureRows feature_rows(source_variants, variants, targets);
  std::vector<std::uint16_t> matrix(feature_rows.sources() * targets.size());
  feature_rows.for_each_run(threads, [&](std::size_t, const auto& rows) {
    rows([&](std::size_t source, std::span<const std::uint16_t> distances) {
      std::copy(distances.begin(), distances.end(), matrix.begin() + source * targets.size());
    });
  });
  return matrix;
}

FeatureDistanceHistogram feature_distance_histogram(std::span<const Descriptor> source_variants, std::size_t variants,
                                                    std::span<const Descriptor> targets, int threads) {
  FeatureDistanceHistogram total{};
  std::mutex mutex;
  FeatureRows(source_variants, variants, targets).for_each_run(threads, [&](std::size_t, const auto& rows) {
    std::array<FeatureDistanceHistogram, 4> partial{};
    rows([&](std::size_t, std::span<const std::uint16_t> distances) { add_to_histograms(distances, partial); });
    const std::lock_guard lock(mutex);
    for (const FeatureDistanceHistogram& histogram : partial) {
      for (std::size_t bin = 0; bin < total.size(); ++bin) total[bin] += histogram[bin];
    }
  });
  return total;
}

FeatureDistanceStatistics feature_distance_statistics(const FeatureDistanceHistogram& histogram) {
  std::uint64_t pairs = 0, sum = 0;
  for (std::size_t distance = 0; distance < histogram.size(); ++distance) {
    pairs += histogram[distance];
    sum += distance * histogram[distance];
  }
  if (pairs == 0) return {};
  const double mean = static_cast<double>(sum) / static_cast<double>(pairs);
  double squares = 0.0;
  for (std::size_t distance = 0; distance < histogram.size(); ++distance) {
    const double deviation = static_cast<double>(distance) - mean;
    squares += deviation * deviation * static_cast<double>(histogram[distance]);
  }
  return {mean, std::sqrt(squares / static_cast<double>(pairs))};
}

std::vector<FeaturePair> feature_pairs_below(std::span<const Descriptor> source_variants, std::size_t variants,
                                             std::span<const Descriptor> targets, double threshold, int threads) {
  if (std::isnan(threshold)) throw InvalidArgument("threshold: NaN, must be a number of bits");
  const auto limit = static_cast<std::uint16_t>(std::clamp(std::ceil(threshold), 0.0, max_feature_distance + 1.0));
  const FeatureRows feature_rows(source_variants, variants, targets);
  std::vector<std::vector<FeaturePair>> pairs_of_run(feature_rows.runs());
  feature_rows.for_each_run(threads, [&](std::size_t run, const auto& rows) {
    rows([&](std::size_t source, std::span<const std::uint16_t> distances) {
      append_below(distances, limit, source, pairs_of_run[run]);
    });
  });
  std::vector<FeaturePair> pairs;
  for (const std::vector<FeaturePair>& run : pairs_of_run) pairs.insert(pairs.end(), run.begin(), run.end());
  return pairs;
}

}  // namespace igsp
