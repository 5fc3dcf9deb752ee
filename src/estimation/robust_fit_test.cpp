#include "estimation/robust_fit.hpp"

#include <gtest/gtest.h>

#include <array>

#include "core/core_testing.hpp"
#include "igsp/evaluation.hpp"

namespace igsp {
namespace {

using testing::Random;

TEST(GemanMcClure, WeightsResiduals) {
  EXPECT_EQ(geman_mcclure_weight(0, 4), 1);
  EXPECT_DOUBLE_EQ(geman_mcclure_weight(4, 4), 0.25);  // 1 / (1 + 1)^2
  EXPECT_DOUBLE_EQ(geman_mcclure_weight(16, 4), 0.04);
  EXPECT_GT(geman_mcclure_weight(35.99, 4), 0);
  EXPECT_EQ(geman_mcclure_weight(36.01, 4), 0);
}

/// Small motions, so that the identity is a start from which the truth can be seen.
Transformation small_motion(Random& random, bool levelled) {
  const Eigen::Vector3d axis = levelled ? Eigen::Vector3d::UnitZ() : random.direction();
  Transformation motion(Eigen::AngleAxisd(random.uniform(-0.05, 0.05), axis));
  motion.translation() = random.in_cube(0.3);
  return motion;
}

constexpr std::array scales{1.0, 0.5, 0.2, 0.1, 0.05};
const Transformation identity = Transformation::Identity();

TEST(RobustFit, HalfOfThePairsMayBeWrong) {
  Random random(1);
  for (const int degrees_of_freedom : {6, 4}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Transformation truth = small_motion(random, degrees_of_freedom == 4);
      std::vector<PointPair> pairs(200);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        pairs[i].source = random.in_cube(5);
        pairs[i].target = truth * pairs[i].source + random.in_cube(0.01);
        if (i % 2 == 0) pairs[i].target = random.in_cube(5);
      }
      const auto fit = robust_fit(pairs, identity, scales, degrees_of_freedom);
      ASSERT_TRUE(fit);
      EXPECT_LT(rotation_error_rad(fit->linear(), truth.linear()), 1e-3);
      EXPECT_LT((fit->translation() - truth.translation()).norm(), 3e-3);
      EXPECT_GE(count_inliers(pairs, *fit, 0.05), 100u);
      EXPECT_LE(count_inliers(pairs, *fit, 0.05), 103u);
    }
  }
}

TEST(RobustFit, DoesNotDependOnTheUnitOfLength) {
  Random random(3);
  const Transformation truth = small_motion(random, false);
  constexpr double unit = 1024;
  std::vector<PointPair> pairs(50), larger(50);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].source = random.in_cube(5);
    pairs[i].target = truth * pairs[i].source + random.in_cube(0.1);
    larger[i] = {unit * pairs[i].source, unit * pairs[i].target, pairs[i].weight};
  }
  constexpr std::array larger_scales{unit * 0.5, unit * 0.1};
  const auto fit = robust_fit(pairs, identity, std::array{0.5, 0.1}, 6);
  const auto larger_fit = robust_fit(larger, identity, larger_scales, 6);
  ASSERT_TRUE(fit && larger_fit);
  EXPECT_LT((fit->linear() - larger_fit->linear()).norm(), 1e-12);
  EXPECT_LT((unit * fit->translation() - larger_fit->translation()).norm(), 1e-9);
}

TEST(RobustFit, KeepsTheWeightsOfThePairs) {
  Random random(2);
  const Transformation truth = small_motion(random, false);
  std::vector<PointPair> pairs;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d p = random.in_cube(5);
    pairs.push_back({p, truth * p});
    pairs.push_back({p, p, 0.0});  // fits the start perfectly, but is not to be looked at
  }
  const auto fit = robust_fit(pairs, identity, scales, 6);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->matrix() - truth.matrix()).norm(), 1e-9);
}

TEST(RobustFit, WithoutScalesIsTheStart) {
  Random random(3);
  const Transformation start = random.motion(5);
  EXPECT_EQ(robust_fit({}, start, {}, 6)->matrix(), start.matrix());
}

TEST(RobustFit, IsEmptyWhenNothingIsNear) {
  Random random(4);
  std::vector<PointPair> pairs(20);
  for (PointPair& pair : pairs) {
    pair.source = random.in_cube(1);
    pair.target = pair.source + Eigen::Vector3d(100, 0, 0);
  }
  EXPECT_FALSE(robust_fit(pairs, identity, scales, 6));
  EXPECT_FALSE(robust_fit({}, identity, scales, 6));
}

TEST(CountInliers, CountsResidualsBelowTheTolerance) {
  std::vector<PointPair> pairs;
  for (const double x : {0.0, 0.5, 0.99, 1.0, 2.0}) {
    pairs.push_back({Eigen::Vector3d::Zero(), Eigen::Vector3d(3 + x, 0, 0)});
  }
  const Transformation shift(Eigen::Translation3d(3, 0, 0));
  EXPECT_EQ(count_inliers(pairs, shift, 1.0), 3u);
  EXPECT_EQ(count_inliers(pairs, identity, 1.0), 0u);
  EXPECT_EQ(count_inliers(pairs, shift, 10.0), 5u);
}

}  // namespace
}  // namespace igsp
