#include "registration/exchange.hpp"

#include <gtest/gtest.h>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using testing::Random;

Result any_result(Random& random) {
  Result result;
  result.target_from_source = random.motion(10);
  result.overlap_source = 0.25, result.overlap_target = 0.75;
  result.source.points = 7, result.target.points = 11;
  result.source_keypoints = testing::random_points(random, 3, 5);
  result.target_keypoints = testing::random_points(random, 4, 5);
  result.evidence.free_space.source = FreeSpaceViolation{100, 3};
  result.runner_up = RunnerUp{random.motion(10), 0.5};
  Matrix6 root;
  for (double& entry : root.reshaped()) entry = random.uniform(-1, 1);
  Precision& precision = result.precision;
  precision.centre = random.in_cube(10);
  precision.information = root * root.transpose() + Matrix6::Identity();
  precision.covariance = precision.information.inverse();
  precision.scale = 1.25, precision.scale_sigma = 0.05;
  precision.free_directions.push_back({root.col(0).normalized(), ""});
  IterationRecord record;
  record.target_from_source = random.motion(10);
  record.correspondences = {{0, 3}, {2, 1}};
  result.iterations.push_back(record);
  return result;
}

// A rotation about the centre, then a translation.
Transformation motion_of(const Vector6& step, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d rotation = step.head<3>();
  Transformation motion(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
  motion.translation() = centre + step.tail<3>() - motion.linear() * centre;
  return motion;
}

Vector6 step_of(const Transformation& motion, const Eigen::Vector3d& centre) {
  const Eigen::AngleAxisd rotation(motion.linear());
  Vector6 step;
  step << rotation.angle() * rotation.axis(), motion * centre - centre;
  return step;
}

// A pose that is wrong by a small motion is as improbable whichever cloud is said to move: to first order.
TEST(Exchange, ErrorsWeighAsBefore) {
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Result before = any_result(random);
    Result after = before;
    exchange_clouds(after);
    Vector6 step;
    for (double& entry : step) entry = random.uniform(-1e-5, 1e-5);
    const Transformation wrong = motion_of(step, before.precision.centre) * before.target_from_source;
    const Vector6 seen = step_of(wrong.inverse() * after.target_from_source.inverse(), after.precision.centre);
    const double weight = step.dot(before.precision.information * step);
    EXPECT_NEAR(seen.dot(after.precision.information * seen), weight, 1e-3 * weight);
    EXPECT_LT((after.precision.covariance * after.precision.information - Matrix6::Identity()).norm(), 1e-9);
  }
}

TEST(Exchange, CentreAndFreeDirectionsAreTheSamePlacesInTheOtherFrame) {
  Random random(2);
  const Result before = any_result(random);
  Result after = before;
  exchange_clouds(after);
  EXPECT_LT((before.target_from_source * after.precision.centre - before.precision.centre).norm(), 1e-12);
  const Vector6 &motion = before.precision.free_directions[0].motion, &seen = after.precision.free_directions[0].motion;
  EXPECT_LT((before.target_from_source.linear() * seen.head<3>() - motion.head<3>()).norm(), 1e-12);
  EXPECT_LT((before.target_from_source.linear() * seen.tail<3>() - motion.tail<3>()).norm(), 1e-12);
  EXPECT_FALSE(after.precision.free_directions[0].description.empty());
}

TEST(Exchange, OfTheSourcesScaleIsItsInverse) {
  Random random(3);
  Result result = any_result(random);
  exchange_clouds(result);
  EXPECT_DOUBLE_EQ(result.precision.scale, 1 / 1.25);
  EXPECT_DOUBLE_EQ(result.precision.scale_sigma / result.precision.scale, 0.05 / 1.25);
}

TEST(Exchange, PutsEverythingUnderTheOtherName) {
  Random random(4);
  const Result before = any_result(random);
  Result after = before;
  exchange_clouds(after);
  EXPECT_TRUE((after.target_from_source * before.target_from_source).isApprox(Transformation::Identity(), 1e-12));
  EXPECT_EQ(after.overlap_source, 0.75);
  EXPECT_EQ(after.source.points, 11u);
  EXPECT_EQ(after.source_keypoints, before.target_keypoints);
  EXPECT_FALSE(after.evidence.free_space.source);
  ASSERT_TRUE(after.evidence.free_space.target);
  EXPECT_EQ(after.evidence.free_space.target->contradicting, 3u);
  EXPECT_TRUE((after.runner_up->target_from_source * before.runner_up->target_from_source)
                  .isApprox(Transformation::Identity(), 1e-12));
  const IterationRecord &was = before.iterations[0], &is = after.iterations[0];
  EXPECT_TRUE((is.target_from_source * was.target_from_source).isApprox(Transformation::Identity(), 1e-12));
  EXPECT_EQ(is.correspondences[0].source, 3u);
  EXPECT_EQ(is.correspondences[0].target, 0u);
}

}  // namespace
}  // namespace igsp
