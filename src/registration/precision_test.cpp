#include "registration/precision.hpp"

#include <gtest/gtest.h>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using testing::BumpySurface;
using testing::Random;

constexpr double noise = 0.01;

// A surface and itself with noise along z, in some unit of length.
Precision precision_in(double unit) {
  Random random(1);
  Features source, target;
  source.voxel_size = target.voxel_size = 0.2 * unit;
  target.fine_points = BumpySurface(random, 0.2).sample(random, 4000, 2);
  source.fine_points = target.fine_points;
  for (Eigen::Vector3d& point : source.fine_points) point.z() += noise * random.normal();
  for (Points* points : {&source.fine_points, &target.fine_points}) {
    for (Eigen::Vector3d& point : *points) point *= unit;
  }
  const FineSurfaces surfaces(source, target, 1);
  return precision_at(surfaces, Transformation::Identity(), 6);
}

TEST(Precision, InlierRmseIsTheNoiseAlongTheNormals) {
  EXPECT_LT(precision_in(1).inlier_rmse, noise);
  EXPECT_GT(precision_in(1).inlier_rmse, 0.5 * noise);
}

// Rotations have no unit; what is known of a translation is known in the unit of length.
TEST(Precision, InformationHasTheUnitOfTheClouds) {
  const double unit = 4;
  const Matrix6 one = precision_in(1).information, other = precision_in(unit).information;
  Matrix6 expected = one;
  expected.rightCols<3>() /= unit;
  expected.bottomRows<3>() /= unit;
  EXPECT_LT((other - expected).norm(), 1e-6 * expected.norm());
}

// n pairs of one sigma fix the heights' mean to sigma / sqrt(n), and what patches share is estimated from few of them.
TEST(Precision, OfAHeightIsThatOfAMean) {
  const Precision precision = precision_in(1);
  const double sigma = precision.inlier_rmse / std::sqrt(4000.0);
  EXPECT_GT(std::sqrt(1 / precision.information(5, 5)), 0.7 * sigma);
  EXPECT_LT(std::sqrt(1 / precision.information(5, 5)), 2 * sigma);
  EXPECT_LT((precision.covariance * precision.information - Matrix6::Identity()).norm(), 1e-6);
}

TEST(Precision, OfTwiceTheSameSurfaceTellsItsScale) {
  const Precision precision = precision_in(1);
  EXPECT_NEAR(precision.scale, 1, 10 * precision.scale_sigma);
  EXPECT_GT(precision.scale_sigma, 0);
  EXPECT_FALSE(is_of_another_scale(precision));
  Precision larger = precision;
  larger.scale = 1.05;
  EXPECT_TRUE(is_of_another_scale(larger));
}

}  // namespace
}  // namespace igsp
