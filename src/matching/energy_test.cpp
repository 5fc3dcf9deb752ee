#include "matching/energy.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "features/bsc.hpp"
#include "features/features_testing.hpp"

namespace igsp {
namespace {

using testing::Random;

/// Keypoints of both clouds with the storage that KeypointSets refers to.
struct Sets {
  Points source, target;
  std::vector<Descriptor> source_variants, target_descriptors;
  int variants = 4;
  operator KeypointSets() const { return {source, target, source_variants, variants, target_descriptors}; }
};

/// Every second target is a source with a few bits changed, seen under one of its sign variants.
Sets random_sets(Random& random, std::size_t sources, std::size_t targets, double half_side, int variants = 4) {
  Sets sets;
  sets.variants = variants;
  sets.source = testing::random_points(random, sources, half_side);
  sets.target = testing::random_points(random, targets, half_side);
  std::vector<Descriptor> own;
  for (std::size_t i = 0; i < sources; ++i) own.push_back(testing::random_descriptor(random));
  sets.source_variants = sign_variants(own, variants);
  for (std::size_t j = 0; j < targets; ++j) {
    Descriptor descriptor = testing::random_descriptor(random);
    if (j % 2 == 0 && j < sources) {
      descriptor = flipped(own[j], random.integer(0, variants - 1));
      for (int change = random.integer(0, 20); change > 0; --change) {
        const int bit = random.integer(0, bsc_bits - 1);
        descriptor[bit / 64] ^= std::uint64_t{1} << (bit % 64);
      }
      sets.target[j] = sets.source[j] + random.in_cube(0.2);
    }
    sets.target_descriptors.push_back(descriptor);
  }
  return sets;
}

/// FD of Eq. 4, plainly.
double plain_fd(const Sets& sets, std::size_t i, std::size_t j) {
  int least = std::numeric_limits<int>::max();
  for (int v = 0; v < sets.variants; ++v) {
    const Descriptor& variant = sets.source_variants[i * sets.variants + v];
    least = std::min(least, testing::differing_bits(variant, sets.target_descriptors[j]));
  }
  return least;
}

/// CD of Eq. 2-3, plainly.
double plain_cd(const Sets& sets, std::size_t i, std::size_t j, double ed_scale, const EnergyWeights& weights) {
  return weights.fd * plain_fd(sets, i, j) + weights.ed * (ed_scale * (sets.source[i] - sets.target[j]).norm());
}

std::vector<AssignmentEdge> plain_edges(const Sets& sets, double ed_scale, const EnergyWeights& weights,
                                        double threshold) {
  std::vector<AssignmentEdge> edges;
  for (std::uint32_t i = 0; i < sets.source.size(); ++i) {
    for (std::uint32_t j = 0; j < sets.target.size(); ++j) {
      const std::int64_t cost = to_assignment_units(plain_cd(sets, i, j, ed_scale, weights));
      if (cost < to_assignment_units(threshold)) edges.push_back({i, j, cost});
    }
  }
  return edges;
}

bool same_edges(const std::vector<AssignmentEdge>& a, const std::vector<AssignmentEdge>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const AssignmentEdge& x, const AssignmentEdge& y) {
    return x.source == y.source && x.target == y.target && x.cost == y.cost;
  });
}

// --- Weights and thresholds ---

TEST(EnergyWeights, FollowEquation7) {
  EXPECT_EQ(energy_weights(0, 8).fd, 1);
  EXPECT_EQ(energy_weights(0, 8).ed, 0);
  EXPECT_DOUBLE_EQ(energy_weights(8, 8).fd, std::exp(-1.0));
  EXPECT_DOUBLE_EQ(energy_weights(3, 6).fd, std::exp(-0.5));
  for (int k = 0; k < 50; ++k) {
    const EnergyWeights weights = energy_weights(k, 8);
    EXPECT_EQ(weights.fd + weights.ed, 1) << "k = " << k;
    EXPECT_LT(energy_weights(k + 1, 8).fd, weights.fd);
  }
}

TEST(FeatureDistanceSpread, IsThatOfAllPairs) {
  Random random(1);
  for (const int variants : {1, 2, 4}) {
    const Sets sets = random_sets(random, 30, 20, 1, variants);
    double mean = 0, mean2 = 0;
    for (std::size_t i = 0; i < 30; ++i) {
      for (std::size_t j = 0; j < 20; ++j) {
        mean += plain_fd(sets, i, j) / 600;
        mean2 += plain_fd(sets, i, j) * plain_fd(sets, i, j) / 600;
      }
    }
    const DistanceSpread spread = feature_distance_spread(sets, 1);
    EXPECT_NEAR(spread.mean, mean, 1e-9);
    EXPECT_NEAR(spread.sigma, std::sqrt(mean2 - mean * mean), 1e-8);
  }
}

TEST(CompoundDistanceSpread, IsThatOfAllPairs) {
  Random random(2);
  const Sets sets = random_sets(random, 30, 20, 1);
  const EnergyWeights weights = energy_weights(1, 8);
  double mean = 0, mean2 = 0;
  for (std::size_t i = 0; i < 30; ++i) {
    for (std::size_t j = 0; j < 20; ++j) {
      const double cd = plain_cd(sets, i, j, 17.0, weights);
      mean += cd / 600;
      mean2 += cd * cd / 600;
    }
  }
  const DistanceSpread one = compound_distance_spread(sets, 17.0, weights, 1);
  EXPECT_NEAR(one.mean, mean, 1e-9);
  EXPECT_NEAR(one.sigma, std::sqrt(mean2 - mean * mean), 1e-8);
  for (const int threads : {2, 4}) {
    const DistanceSpread many = compound_distance_spread(sets, 17.0, weights, threads);
    EXPECT_EQ(many.mean, one.mean);
    EXPECT_EQ(many.sigma, one.sigma);
  }
}

TEST(InitialThreshold, IsMeanMinusSigmasAboveTheFloor) {
  EnergyOptions options;
  options.p1 = 2.5;
  options.min_threshold = 5;
  EXPECT_DOUBLE_EQ(initial_threshold({100, 10}, options), 75);
  EXPECT_EQ(initial_threshold({20, 10}, options), 5);
  options.min_threshold = 0.5;
  EXPECT_EQ(initial_threshold({20, 10}, options), 0.5);
}

// Two matches, FD 10 and 30, distances 1 and 3 with s_ed = 2: mean FD 20, mean ED 4, RMS ED sqrt(20), std FD 10.
const std::vector<Correspondence> two_matches{{0, 0, 10, 1}, {1, 1, 30, 3}};

TEST(NextThreshold, PaperRuleByHand) {
  EnergyOptions options;
  options.p2 = 1.5;
  options.p3 = 1.25;
  EXPECT_DOUBLE_EQ(next_threshold(two_matches, 2, {0.75, 0.25}, 99, options), 1.5 * 0.25 * 4 + 1.25 * 0.75 * 20);
}

TEST(NextThreshold, ReleasedRuleByHand) {
  EnergyOptions options;
  options.threshold_rule = ThresholdRule::released;
  options.released_p_ed = 1.1;
  options.released_p_fd = 0.9;
  EXPECT_DOUBLE_EQ(next_threshold(two_matches, 2, {0.75, 0.25}, 99, options),
                   0.25 * std::sqrt(20.0) * 1.1 + 0.75 * (20 + 0.9 * 10));
}

TEST(NextThreshold, HasAFloorAndKeepsTheLastWhenNothingMatched) {
  EnergyOptions options;
  options.min_threshold = 5;
  const std::vector<Correspondence> perfect{{0, 0, 0, 0}, {1, 1, 1, 0}};
  for (const ThresholdRule rule : {ThresholdRule::paper, ThresholdRule::released}) {
    options.threshold_rule = rule;
    EXPECT_EQ(next_threshold(perfect, 2, {0.75, 0.25}, 99, options), 5);
    EXPECT_EQ(next_threshold({}, 2, {0.75, 0.25}, 42, options), 42);
  }
}

// --- Candidate edges ---

RC_GTEST_PROP(CandidateEdges, AtTheStartEqualAPlainDoubleLoop, (std::uint64_t seed)) {
  Random random(seed);
  const int variants = random.integer(0, 1) == 0 ? 4 : 2;
  const Sets sets = random_sets(random, random.integer(0, 40), random.integer(0, 40), 1, variants);
  const double threshold = random.integer(0, 1) == 0 ? random.integer(1, 230) : random.uniform(1, 230);
  RC_ASSERT(same_edges(candidate_edges(sets, 10, {1, 0}, threshold, 1), plain_edges(sets, 10, {1, 0}, threshold)));
}

RC_GTEST_PROP(CandidateEdges, LaterEqualAPlainDoubleLoop, (std::uint64_t seed)) {
  Random random(seed);
  const Sets sets = random_sets(random, random.integer(0, 60), random.integer(0, 60), random.uniform(0.5, 10));
  const EnergyWeights weights = energy_weights(random.integer(1, 40), random.uniform(2, 10));
  const double ed_scale = std::exp(random.uniform(-2, 5));  // from far more than the scene to next to nothing
  const double threshold = random.uniform(5, 200);
  const auto expected = plain_edges(sets, ed_scale, weights, threshold);
  RC_ASSERT(same_edges(candidate_edges(sets, ed_scale, weights, threshold, 1), expected));
  RC_ASSERT(same_edges(candidate_edges(sets, ed_scale, weights, threshold, 4), expected));
}

TEST(CandidateEdges, ReachAllPairsWhenTheRadiusExceedsTheScene) {
  Random random(3);
  const Sets sets = random_sets(random, 30, 30, 1);
  for (const double ed : {1e-2, 1e-9, 1e-300}) {
    const EnergyWeights weights{1 - ed, ed};
    EXPECT_EQ(candidate_edges(sets, 1, weights, 436, 1).size(), 900u);
    EXPECT_TRUE(same_edges(candidate_edges(sets, 1, weights, 190, 1), plain_edges(sets, 1, weights, 190)));
  }
}

TEST(CandidateEdges, AreStrictlyBelowTheThreshold) {
  Sets sets;
  sets.source = {{0, 0, 0}};
  sets.target = {{1, 0, 0}};
  sets.source_variants = sign_variants(std::vector<Descriptor>(1), 4);
  sets.target_descriptors = {Descriptor{0xff}};  // FD = 8
  EXPECT_TRUE(candidate_edges(sets, 1, {1, 0}, 8, 1).empty());
  EXPECT_EQ(candidate_edges(sets, 1, {1, 0}, 9, 1).size(), 1u);
  // CD = 0.5 * 8 + 0.5 * 16 * 1 = 12
  EXPECT_TRUE(candidate_edges(sets, 16, {0.5, 0.5}, 12, 1).empty());
  EXPECT_EQ(candidate_edges(sets, 16, {0.5, 0.5}, 12.001, 1).size(), 1u);
}

TEST(CandidateEdges, BelowAThresholdOfZeroAreNone) {
  Random random(6);
  const Sets sets = random_sets(random, 5, 5, 1);
  for (const EnergyWeights& weights : {EnergyWeights{1, 0}, EnergyWeights{0.5, 0.5}}) {
    EXPECT_TRUE(candidate_edges(sets, 1, weights, 0, 1).empty());
  }
}

// The assignment refuses a cost that is not below the threshold once both are rounded to its units.
TEST(CandidateEdges, AreAdmissibleWhenTheThresholdIsAHairAboveACost) {
  Sets sets;
  sets.source = sets.target = {{0, 0, 0}};
  sets.source_variants = sign_variants(std::vector<Descriptor>(1), 4);
  sets.target_descriptors = {Descriptor{0xff}};
  for (const EnergyWeights& weights : {EnergyWeights{1, 0}, EnergyWeights{0.5, 0.5}}) {
    const double threshold = 8 * weights.fd + 1e-8;
    const auto edges = candidate_edges(sets, 1, weights, threshold, 1);
    EXPECT_NO_THROW(solve_assignment(1, 1, edges, to_assignment_units(threshold)));
  }
}

// Small keypoint spacing in a large scene: 5 cm voxels over four kilometres.
TEST(CandidateEdges, MissNothingInALargeScene) {
  Random random(4);
  Sets sets = random_sets(random, 400, 400, 2000);
  const EnergyWeights weights = energy_weights(20, 8);
  const double ed_scale = 30 / 0.15, threshold = 5, radius = threshold / (ed_scale * weights.ed);
  sets.target = sets.source;
  for (std::size_t i = 0; i < sets.source.size(); ++i) {
    sets.target[i] += random.uniform(0.9995, 1.0) * radius * random.direction();
    sets.target_descriptors[i] = sets.source_variants[4 * i];
  }
  EXPECT_TRUE(same_edges(candidate_edges(sets, ed_scale, weights, threshold, 1),
                         plain_edges(sets, ed_scale, weights, threshold)));
}

// --- The energy itself ---

Assignment solve(const Sets& sets, double ed_scale, const EnergyWeights& weights, double threshold) {
  const auto edges = candidate_edges(sets, ed_scale, weights, threshold, 1);
  return solve_assignment(sets.source.size(), sets.target.size(), edges, to_assignment_units(threshold));
}

/// Eq. 1 over the given pairs, with W_p = T / 2 for every unmatched keypoint of both sets.
double plain_energy(const Sets& sets, const std::vector<std::pair<std::size_t, std::size_t>>& pairs, double ed_scale,
                    const EnergyWeights& weights, double threshold) {
  double energy = 0;
  for (const auto& [i, j] : pairs) energy += plain_cd(sets, i, j, ed_scale, weights);
  const auto unmatched = static_cast<double>(sets.source.size() + sets.target.size() - 2 * pairs.size());
  return energy + threshold / 2 * unmatched;
}

/// The least energy over all one-to-one matchings, the unmatched ones included.
double least_energy(const Sets& sets, double ed_scale, const EnergyWeights& weights, double threshold, std::size_t i,
                    std::vector<char>& taken, std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  if (i == sets.source.size()) return plain_energy(sets, pairs, ed_scale, weights, threshold);
  double least = least_energy(sets, ed_scale, weights, threshold, i + 1, taken, pairs);
  for (std::size_t j = 0; j < sets.target.size(); ++j) {
    if (taken[j]) continue;
    taken[j] = 1;
    pairs.emplace_back(i, j);
    least = std::min(least, least_energy(sets, ed_scale, weights, threshold, i + 1, taken, pairs));
    pairs.pop_back();
    taken[j] = 0;
  }
  return least;
}

RC_GTEST_PROP(MatchingEnergy, IsEquation1OfTheMatches, (std::uint64_t seed)) {
  Random random(seed);
  const Sets sets = random_sets(random, random.integer(1, 30), random.integer(1, 30), 1);
  const EnergyWeights weights = energy_weights(random.integer(0, 8), 8);
  const double threshold = random.uniform(20, 200);
  const Assignment assignment = solve(sets, 30, weights, threshold);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const auto matched = correspondences_of(assignment, sets);
  for (const Correspondence& c : matched) {
    RC_ASSERT(assignment.target_of_source[c.source] == static_cast<std::int32_t>(c.target));
    RC_ASSERT(c.feature_distance == plain_fd(sets, c.source, c.target));
    RC_ASSERT(c.euclidean_distance == (sets.source[c.source] - sets.target[c.target]).norm());
    pairs.emplace_back(c.source, c.target);
  }
  RC_ASSERT(pairs.size() == assignment.matches);
  RC_ASSERT(std::abs(matching_energy(assignment, sets, threshold) - plain_energy(sets, pairs, 30, weights, threshold)) <
            1e-4);
}

RC_GTEST_PROP(MatchingEnergy, IsTheLeastOfAllMatchings, (std::uint64_t seed)) {
  Random random(seed);
  const Sets sets = random_sets(random, random.integer(0, 4), random.integer(0, 5), 1);
  const EnergyWeights weights = energy_weights(random.integer(0, 8), 8);
  const double threshold = random.uniform(20, 300);
  std::vector<char> taken(sets.target.size(), 0);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const double least = least_energy(sets, 30, weights, threshold, 0, taken, pairs);
  RC_ASSERT(std::abs(matching_energy(solve(sets, 30, weights, threshold), sets, threshold) - least) < 1e-4);
}

TEST(UpdateDistances, TakesTheNewPositionsAndKeepsTheFeatureDistances) {
  Random random(5);
  Sets sets = random_sets(random, 10, 10, 1);
  std::vector<Correspondence> matched{{2, 3, 17, 99}, {5, 1, 4, 99}};
  for (Eigen::Vector3d& point : sets.source) point += Eigen::Vector3d(1, 2, 3);
  update_distances(matched, sets);
  EXPECT_EQ(matched[0].euclidean_distance, (sets.source[2] - sets.target[3]).norm());
  EXPECT_EQ(matched[1].euclidean_distance, (sets.source[5] - sets.target[1]).norm());
  EXPECT_EQ(matched[0].feature_distance, 17);
}

}  // namespace
}  // namespace igsp
