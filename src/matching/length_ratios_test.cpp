#include "matching/length_ratios.hpp"

#include <gtest/gtest.h>

#include "simulation/random.hpp"

namespace igsp {
namespace {

using simulation::Random;

struct Votes {
  Points source, target;
  std::vector<Candidate> candidates;
};

Eigen::Quaternionf random_rotation(Random& random) {
  Eigen::Vector4d q;
  for (double& entry : q) entry = random.uniform(-1, 1);
  return Eigen::Quaterniond(q.normalized()).cast<float>();
}

Eigen::Vector3d random_place(Random& random) {
  return {random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)};
}

// Of `size` candidates the first `right` belong to one similarity, up to 5 degrees and a voxel; the others to nothing.
Votes votes(std::size_t size, std::size_t right, double factor, std::uint64_t seed) {
  Random random(seed);
  const Eigen::Quaternionf rotation = random_rotation(random);
  Votes votes;
  for (std::uint32_t i = 0; i < size; ++i) {
    const Eigen::Vector3d place = random_place(random);
    const Eigen::Vector3d noise = random_place(random) / 50;
    const Eigen::Quaternionf jitter(1, 0.04f * static_cast<float>(noise.x()), 0.04f * static_cast<float>(noise.y()),
                                    0.04f * static_cast<float>(noise.z()));
    const bool is_right = i < right;
    votes.source.push_back(place);
    votes.target.push_back(is_right ? (factor * (rotation.cast<double>() * place) + noise).eval() : random_place(random));
    votes.candidates.push_back({i, i, 1.0f, is_right ? jitter.normalized() * rotation : random_rotation(random)});
  }
  return votes;
}

TEST(LengthRatios, AgreeOnTheFactorOfTheFewThatAreRight) {
  for (const double factor : {0.72, 0.95, 1.0, 1.04, 1.4}) {
    const Votes given = votes(400, 60, factor, 3);
    const RatioPeak peak = ratio_peak(given.candidates, given.source, given.target, 5);
    EXPECT_NEAR(peak.factor / factor, 1.0, 0.015);
    EXPECT_GT(peak.prominence, 20);
  }
}

TEST(LengthRatios, WhatBelongsToNothingHasNoPeak) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Votes given = votes(400, 0, 1, seed);
    EXPECT_LT(ratio_peak(given.candidates, given.source, given.target, 5).prominence, 6);
  }
}

TEST(LengthRatios, WithoutCandidatesThereIsNoVote) {
  EXPECT_EQ(ratio_peak({}, {}, {}, 1).prominence, 0);
}

}  // namespace
}  // namespace igsp
