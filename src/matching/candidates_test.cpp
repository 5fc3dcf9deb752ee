#include "matching/candidates.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "features/bsc.hpp"
#include "features/features_testing.hpp"

namespace igsp {
namespace {

using testing::Random;

struct Keypoints {
  Points positions;
  std::vector<Eigen::Matrix3d> frames;
  std::vector<Descriptor> descriptors;
  operator DescribedKeypoints() const { return {positions, frames, descriptors}; }
};

Keypoints random_keypoints(Random& random, std::size_t size) {
  Keypoints keypoints{testing::random_points(random, size, 10), {}, {}};
  for (std::size_t i = 0; i < size; ++i) {
    keypoints.frames.push_back(random.rotation());
    keypoints.descriptors.push_back(testing::random_descriptor(random));
  }
  return keypoints;
}

struct Fd {
  int distance, flip;  // of the first least variant
};

Fd plain_fd(const Descriptor& source, const Descriptor& target, int variants) {
  Fd best{bsc_bits + 1, 0};
  for (int flip = 0; flip < variants; ++flip) {
    const int distance = testing::differing_bits(flipped(source, flip), target);
    if (distance < best.distance) best = {distance, flip};
  }
  return best;
}

/// All distances, with what the specification needs of them.
struct Table {
  std::size_t m, n;
  std::vector<Fd> fd;
  Fd at(std::size_t i, std::size_t j) const { return fd[i * n + j]; }

  Table(const Keypoints& source, const Keypoints& target, int variants)
      : m(source.positions.size()), n(target.positions.size()) {
    for (const Descriptor& s : source.descriptors) {
      for (const Descriptor& t : target.descriptors) fd.push_back(plain_fd(s, t, variants));
    }
  }

  static double stands_out(const std::vector<double>& others, double value) {
    const double size = static_cast<double>(others.size());
    const double mean = std::accumulate(others.begin(), others.end(), 0.0) / size;
    double variance = 0;
    for (const double other : others) variance += (other - mean) * (other - mean) / size;
    return variance > 0 ? (mean - value) / std::sqrt(variance) : 0;
  }
  double score(std::size_t i, std::size_t j) const {
    std::vector<double> row, column;
    for (std::size_t k = 0; k < n; ++k) row.push_back(at(i, k).distance);
    for (std::size_t k = 0; k < m; ++k) column.push_back(at(k, j).distance);
    return stands_out(row, at(i, j).distance) + stands_out(column, at(i, j).distance);
  }

  using PairSet = std::set<std::pair<std::uint32_t, std::uint32_t>>;
  /// The `count` best of every row and of every column, ties to the lower index.
  PairSet best_of_both_sides(std::size_t count) const {
    PairSet pairs;
    const auto best = [count](std::size_t size, const auto& distance) {
      std::vector<std::uint32_t> order(size);
      std::iota(order.begin(), order.end(), 0u);
      std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
      order.resize(std::min(size, count));
      return order;
    };
    for (std::uint32_t i = 0; i < m; ++i) {
      for (const std::uint32_t j : best(n, [&](std::uint32_t k) { return at(i, k).distance; })) pairs.emplace(i, j);
    }
    for (std::uint32_t j = 0; j < n; ++j) {
      for (const std::uint32_t i : best(m, [&](std::uint32_t k) { return at(k, j).distance; })) pairs.emplace(i, j);
    }
    return pairs;
  }
};

RC_GTEST_PROP(Candidates, AreTheBestOfBothSidesThatStandOutMost, (std::uint64_t seed)) {
  Random random(seed);
  const Keypoints source = random_keypoints(random, random.integer(1, 25));
  const Keypoints target = random_keypoints(random, random.integer(1, 25));
  const int variants = random.integer(0, 1) == 0 ? 4 : 2, per_keypoint = random.integer(1, 4);
  const Table table(source, target, variants);
  const Table::PairSet expected = table.best_of_both_sides(per_keypoint);
  const auto all = feature_candidates(source, target, variants, per_keypoint, 1000, 1);
  Table::PairSet found;
  for (std::size_t c = 0; c < all.size(); ++c) {
    found.emplace(all[c].source, all[c].target);
    RC_ASSERT(std::abs(all[c].score - table.score(all[c].source, all[c].target)) < 1e-4);
    RC_ASSERT((c == 0 || all[c - 1].score >= all[c].score));  // the macro's own || would look at both sides
  }
  RC_ASSERT(found.size() == all.size());
  RC_ASSERT(found == expected);

  const int fewer = random.integer(1, static_cast<int>(all.size()));
  const auto kept = feature_candidates(source, target, variants, per_keypoint, fewer, 1);
  RC_ASSERT(kept.size() == static_cast<std::size_t>(fewer));
  for (std::size_t c = 0; c < kept.size(); ++c) {
    RC_ASSERT(kept[c].source == all[c].source && kept[c].target == all[c].target);
  }
}

RC_GTEST_PROP(Candidates, TurnFrameOntoFrameUnderTheBestVariant, (std::uint64_t seed)) {
  Random random(seed);
  const Keypoints source = random_keypoints(random, 8), target = random_keypoints(random, 8);
  for (const int variants : {2, 4}) {
    for (const Candidate& c : feature_candidates(source, target, variants, 2, 1000, 1)) {
      const int flip = plain_fd(source.descriptors[c.source], target.descriptors[c.target], variants).flip;
      const Eigen::Matrix3d turned =
          c.target_from_source.cast<double>().toRotationMatrix() * testing::with_signs(source.frames[c.source], flip);
      RC_ASSERT((turned - target.frames[c.target]).norm() < 1e-5);
    }
  }
}

// A moved copy whose frames came out with other signs: every keypoint finds itself, and its frame tells the rotation.
TEST(Candidates, OfAMovedCopyTellTheMotion) {
  Random random(1);
  const Keypoints source = random_keypoints(random, 50);
  const Transformation truth = random.motion(5);
  Keypoints target;
  for (std::size_t i = 0; i < 50; ++i) {
    const int flip = random.integer(0, 3);
    target.positions.push_back(truth * source.positions[i]);
    target.frames.push_back(truth.linear() * testing::with_signs(source.frames[i], flip));
    target.descriptors.push_back(flipped(source.descriptors[i], flip));
  }
  const auto candidates = feature_candidates(source, target, 4, 1, 50, 1);
  ASSERT_EQ(candidates.size(), 50u);
  for (const Candidate& c : candidates) {
    EXPECT_EQ(c.source, c.target);
    EXPECT_LT((c.target_from_source.cast<double>().toRotationMatrix() - truth.linear()).norm(), 1e-5);
  }
}

TEST(Candidates, AreTheSameForEveryThreadCount) {
  Random random(2);
  const Keypoints source = random_keypoints(random, 150), target = random_keypoints(random, 120);
  const auto one = feature_candidates(source, target, 4, 3, 500, 1);
  for (const int threads : {2, 4}) {
    const auto many = feature_candidates(source, target, 4, 3, 500, threads);
    ASSERT_EQ(many.size(), one.size());
    for (std::size_t c = 0; c < one.size(); ++c) {
      EXPECT_TRUE(many[c].source == one[c].source && many[c].target == one[c].target && many[c].score == one[c].score);
    }
  }
}

TEST(Candidates, OfNoKeypointsAreNone) {
  Random random(3);
  const Keypoints some = random_keypoints(random, 5);
  EXPECT_TRUE(feature_candidates(some, Keypoints{}, 4, 3, 100, 1).empty());
  EXPECT_TRUE(feature_candidates(Keypoints{}, some, 4, 3, 100, 1).empty());
}

}  // namespace
}  // namespace igsp
