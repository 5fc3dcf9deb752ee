#include "matching/hamming.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "igsp/errors.hpp"

namespace igsp {
namespace {

std::vector<Descriptor> random_descriptors(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Descriptor> descriptors(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::uint64_t& word : descriptors[i]) {
      word = i % 3 == 0 ? random() : i % 3 == 1 ? random() & random() & random() : random() | random() | random();
    }
  }
  return descriptors;
}

int reference_distance(std::span<const Descriptor> variants, const Descriptor& target) {
  int least = std::numeric_limits<int>::max();
  for (const Descriptor& variant : variants) {
    int distance = 0;
    for (int bit = 0; bit < bsc_words * 64; ++bit) {
      distance += ((variant[bit / 64] ^ target[bit / 64]) >> (bit % 64)) & 1;
    }
    least = std::min(least, distance);
  }
  return least;
}

std::vector<std::uint16_t> reference_matrix(std::span<const Descriptor> sources, std::size_t variants,
                                            std::span<const Descriptor> targets) {
  std::vector<std::uint16_t> matrix;
  for (std::size_t i = 0; i < sources.size(); i += variants) {
    for (const Descriptor& target : targets) matrix.push_back(reference_distance(sources.subspan(i, variants), target));
  }
  return matrix;
}

std::vector<std::uint16_t> matrix_at(SimdLevel level, std::span<const Descriptor> sources, std::size_t variants,
                                     std::span<const Descriptor> targets, int threads) {
  std::vector<std::uint16_t> matrix(sources.size() / variants * targets.size(), 0xffff);
  feature_distance_rows(
      sources, variants, targets, threads,
      [&](std::size_t source, std::span<const std::uint16_t> distances) {
        EXPECT_EQ(distances.size(), targets.size());
        std::copy(distances.begin(), distances.end(), matrix.begin() + source * targets.size());
      },
      level);
  return matrix;
}

class EveryLevel : public testing::TestWithParam<SimdLevel> {};

TEST_P(EveryLevel, EqualsTheBitByBitReference) {
  for (const std::size_t variants : {1, 2, 4, 12}) {
    for (const std::size_t target_count : {0, 1, 31, 32, 33, 70}) {
      const std::vector<Descriptor> sources = random_descriptors(5 * variants, variants);
      const std::vector<Descriptor> targets = random_descriptors(target_count, 100 + target_count);
      EXPECT_EQ(matrix_at(GetParam(), sources, variants, targets, 1), reference_matrix(sources, variants, targets))
          << variants << " variants, " << target_count << " targets";
    }
  }
}

TEST_P(EveryLevel, CountsEveryBitOnce) {
  std::vector<Descriptor> single_bits(bsc_words * 64, Descriptor{});
  std::vector<Descriptor> rising(bsc_words * 64 + 1, Descriptor{});  // j bits set in target j
  for (std::size_t bit = 0; bit < single_bits.size(); ++bit) {
    single_bits[bit][bit / 64] = std::uint64_t{1} << (bit % 64);
    for (std::size_t j = bit + 1; j < rising.size(); ++j) rising[j][bit / 64] |= std::uint64_t{1} << (bit % 64);
  }
  const std::vector<Descriptor> zero(1, Descriptor{});
  EXPECT_EQ(matrix_at(GetParam(), zero, 1, single_bits, 1), std::vector<std::uint16_t>(single_bits.size(), 1));
  const std::vector<std::uint16_t> distances = matrix_at(GetParam(), zero, 1, rising, 1);
  for (std::size_t j = 0; j < rising.size(); ++j) ASSERT_EQ(distances[j], j);
}

TEST_P(EveryLevel, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<Descriptor> sources = random_descriptors(300 * 2, 5), targets = random_descriptors(40, 6);
  const std::vector<std::uint16_t> one = matrix_at(GetParam(), sources, 2, targets, 1);
  EXPECT_EQ(matrix_at(GetParam(), sources, 2, targets, 2), one);
  EXPECT_EQ(matrix_at(GetParam(), sources, 2, targets, 4), one);
}

INSTANTIATE_TEST_SUITE_P(Hamming, EveryLevel, testing::ValuesIn(available_simd_levels()),
                         [](const auto& info) { return std::string(to_string(info.param)); });

TEST(Hamming, BaselineIsAlwaysThereAndTheBestIsAvailable) {
  const std::vector<SimdLevel> levels = available_simd_levels();
  ASSERT_FALSE(levels.empty());
  EXPECT_EQ(levels.front(), SimdLevel::baseline);
  EXPECT_EQ(levels.back(), best_simd_level());
}

TEST(Hamming, EverySourceIsVisitedOnce) {
  const std::vector<Descriptor> sources = random_descriptors(203, 1), targets = random_descriptors(3, 2);
  std::vector<std::atomic<int>> visits(sources.size());
  feature_distance_rows(sources, 1, targets, 2, [&](std::size_t source, auto) { ++visits[source]; });
  for (const std::atomic<int>& count : visits) EXPECT_EQ(count, 1);
}

TEST(Hamming, MatrixAndHistogramAgreeWithTheReferenceForEveryThreadCount) {
  const std::size_t variants = 4;
  const std::vector<Descriptor> sources = random_descriptors(70 * variants, 7), targets = random_descriptors(45, 8);
  const std::vector<std::uint16_t> expected = reference_matrix(sources, variants, targets);
  FeatureDistanceHistogram counts{};
  for (const std::uint16_t distance : expected) ++counts[distance];
  for (const int threads : {1, 2, 4}) {
    EXPECT_EQ(feature_distance_matrix(sources, variants, targets, threads), expected);
    EXPECT_EQ(feature_distance_histogram(sources, variants, targets, threads), counts);
  }
}

TEST(Hamming, StatisticsAreThoseOfAllPairs) {
  const std::vector<Descriptor> sources = random_descriptors(50, 9), targets = random_descriptors(60, 10);
  const std::vector<std::uint16_t> distances = feature_distance_matrix(sources, 1, targets, 1);
  double mean = 0.0, variance = 0.0;
  for (const double d : distances) mean += d / distances.size();
  for (const double d : distances) variance += (d - mean) * (d - mean) / distances.size();
  const FeatureDistanceStatistics statistics =
      feature_distance_statistics(feature_distance_histogram(sources, 1, targets, 1));
  EXPECT_NEAR(statistics.mean, mean, 1e-9);
  EXPECT_NEAR(statistics.sigma, std::sqrt(variance), 1e-9);
}

TEST(Hamming, StatisticsOfNothingAndOfOneValue) {
  EXPECT_EQ(feature_distance_statistics({}).mean, 0.0);
  EXPECT_EQ(feature_distance_statistics({}).sigma, 0.0);
  FeatureDistanceHistogram histogram{};
  histogram[448] = 1'000'000'000'000;  // more pairs than 32 bits count
  EXPECT_EQ(feature_distance_statistics(histogram).mean, 448.0);
  EXPECT_EQ(feature_distance_statistics(histogram).sigma, 0.0);
}

TEST(Hamming, PairsBelowAThresholdAreStrictSortedAndIndependentOfThreads) {
  const std::size_t variants = 2;
  const std::vector<Descriptor> sources = random_descriptors(90 * variants, 11), targets = random_descriptors(50, 12);
  const std::vector<std::uint16_t> matrix = reference_matrix(sources, variants, targets);
  const double present = matrix[17];
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double threshold : {present, present + 0.5, present - 0.5, 0.0, -3.0, 448.0, 449.0, infinity, -infinity}) {
    std::vector<FeaturePair> expected;
    for (std::uint32_t k = 0; k < matrix.size(); ++k) {
      if (matrix[k] < threshold) expected.push_back({k / 50, k % 50, matrix[k]});
    }
    for (const int threads : {1, 2, 4}) {
      EXPECT_EQ(feature_pairs_below(sources, variants, targets, threshold, threads), expected) << threshold;
    }
  }
}

TEST(Hamming, OnDemandDistanceIsTheLesserOfDistanceAndBound) {
  const std::vector<Descriptor> sources = random_descriptors(4, 13), targets = random_descriptors(30, 14);
  for (const Descriptor& target : targets) {
    const int distance = reference_distance(sources, target);
    EXPECT_EQ(feature_distance(sources, target), distance);
    for (const int bound : {0, 1, distance - 1, distance, distance + 1, 448}) {
      EXPECT_EQ(feature_distance(sources, target, static_cast<std::uint16_t>(bound)), std::min(distance, bound));
    }
  }
}

TEST(Hamming, RejectsVariantsThatDoNotFitAndNaN) {
  const std::vector<Descriptor> sources = random_descriptors(6, 15), targets = random_descriptors(3, 16);
  EXPECT_THROW(feature_distance_matrix(sources, 0, targets, 1), InvalidArgument);
  EXPECT_THROW(feature_distance_histogram(sources, 4, targets, 1), InvalidArgument);
  EXPECT_THROW(feature_pairs_below(sources, 1, targets, std::nan(""), 1), InvalidArgument);
  EXPECT_TRUE(feature_distance_matrix({}, 4, targets, 1).empty());
  EXPECT_TRUE(feature_pairs_below(sources, 2, {}, 500.0, 2).empty());
}

}  // namespace
}  // namespace igsp
