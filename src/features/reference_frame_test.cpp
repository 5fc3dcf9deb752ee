#include "features/reference_frame.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Eigenvalues>

#include "features/features_testing.hpp"

namespace igsp {
namespace {

using testing::Random;
using testing::random_support;
using testing::support_of;

constexpr double radius = 2.0;

bool is_proper_frame(const Eigen::Matrix3d& frame) {
  const Eigen::Vector3d y = frame.col(2).cross(frame.col(0));
  return (frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm() < 1e-12 &&
         std::abs(frame.determinant() - 1) < 1e-12 && (frame.col(1) - y).norm() < 1e-12;
}

/// Distance to the nearest frame that differs in proper signs alone: flips 0..3, or 0..1 for levelled frames.
double difference_up_to_signs(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, int variants) {
  double least = (a - b).norm();
  for (int flip = 1; flip < variants; ++flip) least = std::min(least, (a - testing::with_signs(b, flip)).norm());
  return least;
}

RC_GTEST_PROP(ReferenceFrame, IsAProperRotation, (std::uint64_t seed)) {
  Random random(seed);
  Points points = random_support(random, random.integer(0, 60), radius);
  if (random.integer(0, 3) == 0) {
    for (Eigen::Vector3d& point : points) point.z() = 0;  // coplanar
  }
  if (random.integer(0, 3) == 0) {
    for (Eigen::Vector3d& point : points) point.y() = 0;
  }
  RC_ASSERT(is_proper_frame(reference_frame(support_of(points), radius)));
  const Eigen::Matrix3d levelled = levelled_reference_frame(support_of(points), radius);
  RC_ASSERT(is_proper_frame(levelled));
  RC_ASSERT(levelled.col(2) == Eigen::Vector3d::UnitZ());
}

Eigen::Matrix3d specified_covariance(const Points& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    covariance += (std::sqrt(3.0) * radius - point.norm()) * (point - mean) * (point - mean).transpose();
  }
  return covariance;
}

TEST(ReferenceFrame, HasThePrincipalAxesOfTheWeightedCovariance) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Points points = random_support(random, 300, radius);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(specified_covariance(points));
    const Eigen::Vector3d l = solver.eigenvalues();
    const Eigen::Matrix3d frame = reference_frame(support_of(points), radius);
    if (l[1] > 0.9 * l[2] || l[0] > 0.9 * l[1]) continue;  // about any direction is a principal axis
    EXPECT_GT(std::abs(frame.col(0).dot(solver.eigenvectors().col(2))), 1 - 1e-8);
    EXPECT_GT(std::abs(frame.col(2).dot(solver.eigenvectors().col(0))), 1 - 1e-8);
  }
}

TEST(LevelledReferenceFrame, HasTheDominantDirectionInThePlane) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Points points = random_support(random, 300, radius);
    const Eigen::Matrix2d covariance = specified_covariance(points).topLeftCorner<2, 2>();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
    if (solver.eigenvalues()[0] > 0.9 * solver.eigenvalues()[1]) continue;
    const Eigen::Matrix3d frame = levelled_reference_frame(support_of(points), radius);
    EXPECT_GT(std::abs(frame.col(0).head<2>().dot(solver.eigenvectors().col(1))), 1 - 1e-8);
  }
}

/// Supports with principal axes clearly apart, so that rounding to single precision moves the frame little.
Points elongated_support(Random& random) {
  Points points = random_support(random, 400, radius);
  for (Eigen::Vector3d& point : points) point = point.cwiseProduct(Eigen::Vector3d(1, 0.5, 0.2)) * 0.9;
  return points;
}

TEST(ReferenceFrame, TurnsWithTheSupportUpToSigns) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Points points = elongated_support(random);
    Transformation turn = Transformation::Identity();
    turn.linear() = random.rotation();
    const Eigen::Matrix3d frame = reference_frame(support_of(points), radius);
    const Eigen::Matrix3d turned = reference_frame(support_of(testing::moved(turn, points)), radius);
    EXPECT_LT(difference_up_to_signs(turn.linear() * frame, turned, 4), 1e-4);
  }
}

TEST(LevelledReferenceFrame, TurnsWithTheSupportAboutTheVertical) {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Points points = elongated_support(random);
    const Transformation yaw(Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d::UnitZ()));
    const Eigen::Matrix3d frame = levelled_reference_frame(support_of(points), radius);
    const Eigen::Matrix3d turned = levelled_reference_frame(support_of(testing::moved(yaw, points)), radius);
    EXPECT_LT(difference_up_to_signs(yaw.linear() * frame, turned, 2), 1e-4);
  }
}

}  // namespace
}  // namespace igsp
