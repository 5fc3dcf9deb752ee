#include "igsp/evaluation.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <numbers>

#include "core/core_testing.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

using testing::Random;

constexpr double pi = std::numbers::pi;

Eigen::Matrix3d turn(double angle, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

TEST(RotationError, LosesNothingAtSmallAngles) {
  Random random(1);
  for (const double angle : {1e-9, 1e-8, 1e-6, 1e-3, 0.1}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Matrix3d b = random.rotation();
      const Eigen::Matrix3d a = turn(angle, random.direction()) * b;
      EXPECT_NEAR(rotation_error_rad(a, b), angle, 2e-15);  // rounding of the matrices themselves
    }
  }
  EXPECT_EQ(rotation_error_rad(Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()), 0);
}

TEST(RotationError, LosesNothingNearHalfATurn) {
  Random random(2);
  for (const double short_of : {0.0, 1e-9, 1e-6, 1e-3}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Matrix3d b = random.rotation();
      const Eigen::Matrix3d a = turn(pi - short_of, random.direction()) * b;
      EXPECT_NEAR(rotation_error_rad(a, b), pi - short_of, 2e-15);
    }
  }
}

RC_GTEST_PROP(RotationError, IsADistance, (std::uint64_t seed)) {
  Random random(seed);
  const Eigen::Matrix3d a = random.rotation(), b = random.rotation(), c = random.rotation();
  const double ab = rotation_error_rad(a, b);
  RC_ASSERT(ab >= 0 && ab <= pi + 1e-15);
  RC_ASSERT(std::abs(rotation_error_rad(b, a) - ab) < 1e-14);
  RC_ASSERT(ab <= rotation_error_rad(a, c) + rotation_error_rad(c, b) + 1e-14);
  RC_ASSERT(std::abs(rotation_error_rad(c * a, c * b) - ab) < 1e-14);
  RC_ASSERT(std::abs(std::cos(ab) - ((a * b.transpose()).trace() - 1) / 2) < 1e-14);  // Eq. 13
}

// Half a turn about z apart, 1 m along x and a truth 2 m along y: dt = (1, 0, 0) - R_z(pi) (0, 2, 0) = (1, 2, 0).
TEST(PoseError, ByHand) {
  Transformation estimate = Transformation::Identity(), truth = Transformation::Identity();
  estimate.linear() = turn(pi, Eigen::Vector3d::UnitZ());
  estimate.translation() = Eigen::Vector3d(1, 0, 0);
  truth.translation() = Eigen::Vector3d(0, 2, 0);
  const PoseError error = pose_error(estimate, truth, Eigen::Vector3d(3, 0, 7));
  EXPECT_NEAR(error.rotation_rad, pi, 1e-15);
  EXPECT_NEAR(error.translation, std::sqrt(5.0), 1e-14);
  EXPECT_NEAR(error.centroid_displacement, std::sqrt(25.0 + 4.0), 1e-14);  // (-2, 0, 7) against (3, 2, 7)
}

TEST(PoseError, IsZeroForTheTruth) {
  Random random(3);
  const Transformation truth = random.motion(10);
  const PoseError error = pose_error(truth, truth, random.in_cube(10));
  EXPECT_LT(error.rotation_rad, 1e-15);
  EXPECT_LT(error.translation, 1e-14);
  EXPECT_EQ(error.centroid_displacement, 0);
}

RC_GTEST_PROP(PoseError, IsTheTransformationBetweenBothPoses, (std::uint64_t seed)) {
  Random random(seed);
  const Transformation estimate = random.motion(10), truth = random.motion(10);
  const Eigen::Vector3d centroid = random.in_cube(10);
  const PoseError error = pose_error(estimate, truth, centroid);
  const Transformation delta = estimate * truth.inverse();  // Eq. 12
  RC_ASSERT(std::abs(error.translation - delta.translation().norm()) < 1e-12);
  RC_ASSERT(std::abs(error.rotation_rad - Eigen::AngleAxisd(delta.linear()).angle()) < 1e-12);
  // The centroid's displacement does not depend on where the origins lie.
  const Transformation g(Eigen::Translation3d(random.in_cube(100))), h(Eigen::Translation3d(random.in_cube(100)));
  const PoseError shifted = pose_error(h * estimate * g.inverse(), h * truth * g.inverse(), g * centroid);
  RC_ASSERT(std::abs(shifted.centroid_displacement - error.centroid_displacement) < 1e-11);
  RC_ASSERT(std::abs(shifted.rotation_rad - error.rotation_rad) < 1e-12);
}

TEST(MatchQuality, ByHand) {
  for (const double unit : {0.1, 1.0, 10.0}) {
    const Transformation truth(Eigen::Translation3d(10 * unit, 0, 0));
    Points source{{0, 0, 0}, {5, 0, 0}, {0, 5, 0}, {0, 0, 5}};
    Points target{{10, 0, 0.9}, {15, 0, 0}, {10, 5, 1.1}, {50, 50, 50}};  // the third is 1.1 away from its place
    for (Points* points : {&source, &target}) {
      for (Eigen::Vector3d& point : *points) point *= unit;
    }
    const std::vector<KeypointMatch> matches{{0, 0}, {1, 2}, {3, 3}};
    const MatchQuality quality = match_quality(matches, source, target, truth, unit);
    EXPECT_EQ(quality.correct, 1u) << unit;
    EXPECT_EQ(quality.matched, 3u);
    EXPECT_EQ(quality.possible, 2u) << unit;
    EXPECT_DOUBLE_EQ(quality.precision(), 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(quality.recall(), 0.5);
  }
}

TEST(MatchQuality, IndexBeyondTheKeypointsIsRefused) {
  const Points one{{0, 0, 0}};
  for (const KeypointMatch match : {KeypointMatch{1, 0}, KeypointMatch{0, 1}}) {
    EXPECT_THROW(match_quality(std::array{match}, one, one, Transformation::Identity(), 1.0), InvalidArgument);
  }
}

TEST(MatchQuality, NothingMatchedOrPossibleIsZero) {
  const MatchQuality quality = match_quality({}, {}, {}, Transformation::Identity(), 1.0);
  EXPECT_EQ(quality.precision(), 0.0);
  EXPECT_EQ(quality.recall(), 0.0);
  EXPECT_THROW(match_quality({}, {}, {}, Transformation::Identity(), 0.0), InvalidArgument);
}

}  // namespace
}  // namespace igsp
