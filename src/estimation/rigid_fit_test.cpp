#include "estimation/rigid_fit.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using testing::Random;

std::vector<PointPair> noisy_pairs(Random& random, std::size_t size, const Transformation& truth, double noise) {
  std::vector<PointPair> pairs(size);
  for (PointPair& pair : pairs) {
    pair.source = random.in_cube(5);
    pair.target = truth * pair.source + random.in_cube(noise);
  }
  return pairs;
}

double cost(std::span<const PointPair> pairs, const Transformation& t) {
  double sum = 0;
  for (const PointPair& pair : pairs) sum += pair.weight * (pair.target - t * pair.source).squaredNorm();
  return sum;
}

Transformation umeyama(std::span<const PointPair> pairs) {
  Eigen::Matrix3Xd source(3, pairs.size()), target(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    source.col(static_cast<Eigen::Index>(i)) = pairs[i].source;
    target.col(static_cast<Eigen::Index>(i)) = pairs[i].target;
  }
  return Transformation(Eigen::umeyama(source, target, false));
}

bool is_rigid(const Transformation& t) {
  return (t.linear().transpose() * t.linear() - Eigen::Matrix3d::Identity()).norm() < 1e-12 &&
         std::abs(t.linear().determinant() - 1) < 1e-12;
}

RC_GTEST_PROP(RigidFit, EqualsUmeyama, (std::uint64_t seed)) {
  Random random(seed);
  const Transformation truth = random.motion(20);
  const double noise = random.uniform(0, 1);
  const auto pairs = noisy_pairs(random, random.integer(5, 40), truth, noise);
  const auto fit = rigid_fit(pairs);
  RC_ASSERT(fit.has_value());
  RC_ASSERT(is_rigid(*fit));
  RC_ASSERT((fit->matrix() - umeyama(pairs).matrix()).norm() < 1e-8);
}

RC_GTEST_PROP(RigidFit, FindsTheTruthFromThreePairs, (std::uint64_t seed)) {
  Random random(seed);
  const Transformation truth = random.motion(20);
  std::vector<PointPair> pairs;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.3, 0.8, 0)}) {
    pairs.push_back({p, truth * p});
  }
  const auto fit = rigid_fit(pairs);
  RC_ASSERT(fit.has_value());
  RC_ASSERT((fit->matrix() - truth.matrix()).norm() < 1e-9);
}

RC_GTEST_PROP(RigidFit, NeverReflects, (std::uint64_t seed)) {
  Random random(seed);
  const Transformation truth = random.motion(5);
  std::vector<PointPair> pairs(random.integer(3, 20));
  for (PointPair& pair : pairs) {
    pair.source = random.in_cube(5);
    if (seed % 2 == 0) pair.source.z() = 0;  // coplanar: a reflection would fit as well as the rotation
    const Eigen::Vector3d mirrored = pair.source.cwiseProduct(Eigen::Vector3d(1, 1, -1));
    pair.target = truth * mirrored + random.in_cube(0.1);
  }
  const auto fit = rigid_fit(pairs);
  RC_ASSERT(fit.has_value());
  RC_ASSERT(is_rigid(*fit));
}

RC_GTEST_PROP(RigidFit, NoMotionNearByIsBetter, (std::uint64_t seed)) {
  Random random(seed);
  auto pairs = noisy_pairs(random, 15, random.motion(5), 1.0);
  for (PointPair& pair : pairs) pair.weight = random.uniform(0, 2);
  for (const int degrees_of_freedom : {6, 4}) {
    const auto fit = rigid_fit(pairs, degrees_of_freedom);
    RC_ASSERT(fit.has_value());
    for (int trial = 0; trial < 20; ++trial) {
      Transformation step = Transformation::Identity();
      const Eigen::Vector3d axis = degrees_of_freedom == 4 ? Eigen::Vector3d::UnitZ() : random.direction();
      step.linear() = Eigen::AngleAxisd(random.uniform(-0.01, 0.01), axis).toRotationMatrix();
      step.translation() = random.in_cube(0.01);
      RC_ASSERT(cost(pairs, step * *fit) >= cost(pairs, *fit) - 1e-9);
    }
  }
}

TEST(RigidFit, AWeightOfTwoIsThePairTwice) {
  Random random(1);
  auto weighted = noisy_pairs(random, 10, random.motion(5), 1.0);
  auto repeated = weighted;
  repeated.push_back(weighted[3]);
  weighted[3].weight = 2;
  for (const int degrees_of_freedom : {6, 4}) {
    const Transformation a = *rigid_fit(weighted, degrees_of_freedom), b = *rigid_fit(repeated, degrees_of_freedom);
    EXPECT_LT((a.matrix() - b.matrix()).norm(), 1e-10);
  }
}

TEST(RigidFit, AWeightOfZeroIsNoPair) {
  Random random(2);
  const auto good = noisy_pairs(random, 6, random.motion(5), 0.1);
  auto all = good;
  all.push_back({Eigen::Vector3d(100, 0, 0), Eigen::Vector3d(0, 100, 0), 0.0});
  for (const int degrees_of_freedom : {6, 4}) {
    EXPECT_EQ(rigid_fit(all, degrees_of_freedom)->matrix(), rigid_fit(good, degrees_of_freedom)->matrix());
  }
  auto two = good;
  for (std::size_t i = 2; i < two.size(); ++i) two[i].weight = 0;
  EXPECT_FALSE(rigid_fit(two));
}

TEST(RigidFit, FewerThanThreePairsDetermineNothing) {
  Random random(3);
  for (const std::size_t size : {0, 1, 2}) EXPECT_FALSE(rigid_fit(noisy_pairs(random, size, random.motion(5), 0)));
}

TEST(RigidFit, PairsOnALineDetermineNothing) {
  Random random(4);
  for (const double offset : {0.0, 1e3, 5e6}) {
    const Eigen::Vector3d along = random.direction(), start = Eigen::Vector3d::Constant(offset);
    const Transformation truth = random.motion(5);
    std::vector<PointPair> pairs;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d p = start + random.uniform(-5, 5) * along;
      pairs.push_back({p, truth * p});
    }
    EXPECT_FALSE(rigid_fit(pairs)) << "line " << offset << " away from the origin";
    for (PointPair& pair : pairs) pair.source = random.in_cube(5);  // only the targets on a line
    EXPECT_FALSE(rigid_fit(pairs)) << "targets " << offset << " away from the origin";
    for (PointPair& pair : pairs) std::swap(pair.source, pair.target);
    EXPECT_FALSE(rigid_fit(pairs)) << "sources " << offset << " away from the origin";
  }
  EXPECT_FALSE(rigid_fit(std::vector<PointPair>(5, {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(4, 5, 6)})));
}

TEST(RigidFit, HoldsInSurveyCoordinates) {
  Random random(5);
  const Transformation shift(Eigen::Translation3d(500000, 5000000, 100));
  const Transformation truth = random.motion(5), far_truth = shift * truth * shift.inverse();
  std::vector<PointPair> pairs;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const PointPair& pair : noisy_pairs(random, 20, truth, 0)) {
    pairs.push_back({shift * pair.source, shift * pair.target});
    centre += pairs.back().source / 20;
  }
  const Transformation fit = *rigid_fit(pairs);
  EXPECT_LT((fit.linear() - truth.linear()).norm(), 1e-8);
  EXPECT_LT((fit * centre - far_truth * centre).norm(), 1e-8);
}

RC_GTEST_PROP(LevelledRigidFit, FindsYawAndTranslation, (std::uint64_t seed)) {
  Random random(seed);
  Transformation truth(Eigen::AngleAxisd(random.uniform(-3.1, 3.1), Eigen::Vector3d::UnitZ()));
  truth.translation() = random.in_cube(10);
  const auto pairs = noisy_pairs(random, random.integer(2, 20), truth, 0);
  const auto fit = levelled_rigid_fit(pairs);
  RC_ASSERT(fit.has_value());
  RC_ASSERT((fit->matrix() - truth.matrix()).norm() < 1e-8);
  RC_ASSERT(rigid_fit(pairs, 4)->matrix() == fit->matrix());
}

TEST(LevelledRigidFit, StaysLevelWhateverThePairs) {
  Random random(6);
  const Transformation fit = *levelled_rigid_fit(noisy_pairs(random, 20, random.motion(5), 1));
  EXPECT_TRUE(is_rigid(fit));
  EXPECT_EQ(fit.linear().col(2), Eigen::Vector3d::UnitZ());
}

TEST(LevelledRigidFit, PairsAboveEachOtherDetermineNothing) {
  std::vector<PointPair> pairs{{Eigen::Vector3d(1, 2, 0), Eigen::Vector3d(3, 4, 0)}};
  EXPECT_FALSE(levelled_rigid_fit(pairs));
  for (int z = 1; z < 5; ++z) pairs.push_back({Eigen::Vector3d(1, 2, z), Eigen::Vector3d(3, 4, z)});
  EXPECT_FALSE(levelled_rigid_fit(pairs));
  pairs.push_back({Eigen::Vector3d(2, 2, 0), Eigen::Vector3d(3, 5, 0)});
  EXPECT_TRUE(levelled_rigid_fit(pairs));
}

}  // namespace
}  // namespace igsp
