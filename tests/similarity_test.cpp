// Clouds of different units, and those that are measured a few percent too long.
#include "igsp/similarity.hpp"

#include <gtest/gtest.h>

#include "scenes.hpp"

namespace igsp {
namespace {

using testing::Pair;

const Pair& room() {
  static const Pair pair = testing::scrambled(testing::simulated_pair("indoor", 40000), 5);
  return pair;
}

Points times(double factor, Points points) {
  for (Eigen::Vector3d& point : points) point *= factor;
  return points;
}

class Factors : public ::testing::TestWithParam<double> {};

TEST_P(Factors, AreFoundWithThePose) {
  const Pair& pair = room();
  const SimilarityResult found = align_similarity(times(1 / GetParam(), pair.source), pair.target);
  ASSERT_TRUE(found.result.registered) << found.result.reason;
  EXPECT_NEAR(found.factor / GetParam(), 1.0, 1e-3);
  EXPECT_GT(found.sigma, 0);
  EXPECT_LT(testing::disagreement(found.result.target_from_source, pair.truth, pair.source), found.result.voxel_size);
}

// Inches, a few percent to either side, the same unit, feet the other way round, and millimetres.
INSTANTIATE_TEST_SUITE_P(Similarity, Factors, ::testing::Values(0.0254, 0.93, 1.0, 1.05, 3.28084, 0.001));

TEST(Similarity, ScenesThatShareNothingAreNotRegistered) {
  const Pair park = testing::simulated_pair("park", 30000);
  EXPECT_FALSE(align_similarity(room().source, park.target).result.registered);
}

TEST(Similarity, SeveralPercentAreNoRigidMotion) {
  const Pair& pair = room();
  const Result result = align(times(1.05, pair.source), pair.target);
  EXPECT_FALSE(result.registered) << result.reason;
  EXPECT_TRUE(align(pair.source, pair.target).registered);
}

TEST(Similarity, ScaleIsOneAtARightPose) {
  const Pair& pair = room();
  const Precision precision = align(pair.source, pair.target).precision;
  EXPECT_NEAR(precision.scale, 1.0, 2e-3);
  EXPECT_GT(precision.scale_sigma, 0);
}

}  // namespace
}  // namespace igsp
