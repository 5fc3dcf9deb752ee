#include "registration/pose_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using testing::Random;

constexpr double voxel_size = 0.1, radius = voxel_size, sigma = 0.01;

// Places in a cube of 200 voxels, normals of all directions, residuals of one sigma; both the same in every cell of
// `alike`.
std::vector<PlanePair> pairs_alike_within(double alike, std::uint64_t seed) {
  Random random(seed);
  struct Cell {
    Eigen::Vector3d normal;
    double residual;
  };
  std::vector<Cell> cells(7 * 7 * 7);
  for (Cell& cell : cells) cell = {random.direction(), sigma * random.normal()};
  std::vector<PlanePair> pairs(6000);
  for (PlanePair& pair : pairs) {
    pair.place = random.in_cube(100 * voxel_size);
    pair.normal = random.direction();
    pair.residual = sigma * random.normal();
    if (alike == 0) continue;
    const Eigen::Vector3i at = ((pair.place.array() + 100 * voxel_size) / alike).floor().cast<int>();
    const Cell& cell = cells[(at.x() * 7 + at.y()) * 7 + at.z()];
    pair.normal = cell.normal;
    pair.residual = cell.residual;
  }
  return pairs;
}

Matrix6 of_independent_residuals(const std::vector<PlanePair>& pairs, const PoseCovariance& pose) {
  Matrix6 hessian = Matrix6::Zero();
  for (const PlanePair& pair : pairs) {
    Eigen::Matrix<double, 6, 1> jacobian;
    jacobian << (pair.place - pose.centre).cross(pair.normal), pair.normal;
    hessian += jacobian * jacobian.transpose();
  }
  return sigma * sigma * hessian.inverse();
}

// Share of the volumes of both ellipsoids, as a factor of one variance.
double inflation(const Matrix6& covariance, const Matrix6& expected) {
  return std::pow(covariance.determinant() / expected.determinant(), 1.0 / 6);
}

TEST(PoseCovariance, OfIndependentResidualsIsAboutTheUsualOne) {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<PlanePair> pairs = pairs_alike_within(0, seed);
    const PoseCovariance pose = pose_covariance(pairs, radius, voxel_size);
    EXPECT_NEAR(std::sqrt(pose.residual_variance), sigma, 0.2 * sigma);
    sum += inflation(pose.covariance, of_independent_residuals(pairs, pose));
  }
  EXPECT_GT(sum / 10, 0.5);
  EXPECT_LT(sum / 10, 2.0);
}

// 6,000 pairs in about 300 cells of 30 voxels are as good as 300.
TEST(PoseCovariance, ResidualsThatAreAlikeCountAsOne) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<PlanePair> pairs = pairs_alike_within(30 * voxel_size, seed);
    const PoseCovariance pose = pose_covariance(pairs, radius, voxel_size);
    EXPECT_GT(inflation(pose.covariance, of_independent_residuals(pairs, pose)), 2.5) << "seed " << seed;
  }
}

TEST(PoseCovariance, InformationIsItsInverse) {
  const PoseCovariance pose = pose_covariance(pairs_alike_within(30 * voxel_size, 1), radius, voxel_size);
  EXPECT_LT((pose.information * pose.covariance - Matrix6::Identity()).norm(), 1e-6);
  EXPECT_EQ(Eigen::LLT<Matrix6>(pose.covariance).info(), Eigen::Success);
}

// Rotations about x and y are known, so nothing is learnt of the others from what residuals say of those.
TEST(PoseCovariance, OfFourUnknownsIsTheirOwn) {
  using Matrix4 = Eigen::Matrix4d;
  const std::vector<PlanePair> pairs = pairs_alike_within(30 * voxel_size, 1);
  const PoseCovariance pose = pose_covariance(pairs, radius, voxel_size, 4);
  const Matrix4 curvature = pose.curvature.bottomRightCorner<4, 4>().inverse();
  const Matrix4 expected = curvature * pose.gradient_covariance.bottomRightCorner<4, 4>() * curvature;
  const Matrix4 covariance = pose.covariance.bottomRightCorner<4, 4>();
  EXPECT_LT((covariance - expected).norm(), 1e-9 * expected.norm());
  EXPECT_EQ((pose.covariance.topRightCorner<2, 4>().norm()), 0);
  EXPECT_LT((pose.information * pose.covariance - Matrix6::Identity()).norm(), 1e-6);
  const Matrix6 of_six = pose_covariance(pairs, radius, voxel_size).information;
  EXPECT_GT((of_six.bottomRightCorner<4, 4>() - covariance.inverse()).norm(), 1e-3 * covariance.inverse().norm());
}

TEST(PoseCovariance, HasTheUnitOfTheClouds) {
  const double unit = 8;
  std::vector<PlanePair> pairs = pairs_alike_within(30 * voxel_size, 2);
  const PoseCovariance one = pose_covariance(pairs, radius, voxel_size);
  for (PlanePair& pair : pairs) pair.place *= unit, pair.residual *= unit;
  const PoseCovariance other = pose_covariance(pairs, unit * radius, unit * voxel_size);
  Matrix6 expected = one.covariance;
  expected.rightCols<3>() *= unit;
  expected.bottomRows<3>() *= unit;
  EXPECT_LT((other.covariance - expected).norm(), 1e-12 * expected.norm());
}

// A plane says nothing of three motions.
TEST(PoseCovariance, IsEmptyWhereSomethingIsFree) {
  Random random(3);
  std::vector<PlanePair> pairs(500);
  for (PlanePair& pair : pairs) {
    pair = {{random.uniform(-5, 5), random.uniform(-5, 5), 0}, Eigen::Vector3d::UnitZ(), sigma * random.normal()};
  }
  const PoseCovariance pose = pose_covariance(pairs, radius, voxel_size);
  EXPECT_EQ(pose.covariance, Matrix6::Zero());
  EXPECT_NEAR(pose.information(5, 5) * sigma * sigma, 500, 200) << "but what is known is told";
  EXPECT_EQ(pose_covariance({}, radius, voxel_size).covariance, Matrix6::Zero());
}

// Found by a fuzzer: the patches had no size, and their numbers were none.
TEST(PoseCovariance, OfPairsAtOnePlaceIsNotKnown) {
  const std::vector<PlanePair> pairs(3, {{1, 2, 3}, Eigen::Vector3d::UnitX(), sigma});
  const PoseCovariance pose = pose_covariance(pairs, radius, voxel_size);
  EXPECT_TRUE(pose.information.allFinite());
  EXPECT_TRUE(pose.covariance.isZero());
}

}  // namespace
}  // namespace igsp
