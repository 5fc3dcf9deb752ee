#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "igsp/features.hpp"
#include "matching/hamming_kernel.hpp"

namespace igsp {

// The feature distance FD of Eq. 4: the least Hamming distance [bits] between any variant of the source's descriptor
// and the target's. Everywhere below `source_variants` holds the variants of source 0, then those of source 1, and so
// on, `variants` of them each. All throw InvalidArgument when `variants` is below 1 or does not divide their number,
// and no result depends on the number of threads (0: all processors).

inline constexpr std::uint16_t max_feature_distance = bsc_words * 64;

/// One pair on demand: min(FD, bound).
inline std::uint16_t feature_distance(std::span<const Descriptor> variants_of_source, const Descriptor& target,
                                      std::uint16_t bound = max_feature_distance) {
  return least_distance(variants_of_source, target, bound);
}

/// Called once for every source, from any thread and in any order, with the distances to all targets; these are valid
/// during the call.
using FeatureDistanceVisitor = std::function<void(std::size_t source, std::span<const std::uint16_t> distances)>;
void feature_distance_rows(std::span<const Descriptor> source_variants, std::size_t variants,
                           std::span<const Descriptor> targets, int threads, const FeatureDistanceVisitor& visit,
                           SimdLevel level = best_simd_level());

/// Row-major, sources x targets. For small sets: it takes two bytes a pair.
std::vector<std::uint16_t> feature_distance_matrix(std::span<const Descriptor> source_variants, std::size_t variants,
                                                   std::span<const Descriptor> targets, int threads);

/// Pairs per distance, over all pairs.
using FeatureDistanceHistogram = std::array<std::uint64_t, max_feature_distance + 1>;
FeatureDistanceHistogram feature_distance_histogram(std::span<const Descriptor> source_variants, std::size_t variants,
                                                    std::span<const Descriptor> targets, int threads);

/// mu and sigma (of the population) for Eq. 11 at k = 0; both 0 for an empty histogram.
struct FeatureDistanceStatistics {
  double mean = 0.0;
  double sigma = 0.0;
};
FeatureDistanceStatistics feature_distance_statistics(const FeatureDistanceHistogram& histogram);

struct FeaturePair {
  std::uint32_t source;
  std::uint32_t target;
  std::uint16_t distance;

  bool operator==(const FeaturePair&) const = default;
};

/// All pairs with FD < threshold (strict), sorted by (source, target). Throws InvalidArgument for NaN.
std::vector<FeaturePair> feature_pairs_below(std::span<const Descriptor> source_variants, std::size_t variants,
                                             std::span<const Descriptor> targets, double threshold, int threads);

}  // namespace igsp
