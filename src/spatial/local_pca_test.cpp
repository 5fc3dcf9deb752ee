#include "spatial/local_pca.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cstring>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using testing::BumpySurface;
using testing::Random;

LocalPca pca_of(const Points& points, double radius, int threads = 1) {
  return local_pca(PointGrid(points, 0.5 * radius), radius, threads);
}

struct Reference {
  Eigen::Vector3d eigenvalues;  // ascending
  Eigen::Vector3d normal;
  std::size_t neighbours;
};

/// Plainly and in double precision; membership in the sphere in single precision, as points on its rim would differ.
Reference reference_at(const Points& points, std::size_t centre, double radius) {
  Points sphere;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    if ((point.cast<float>() - points[centre].cast<float>()).norm() > static_cast<float>(radius)) continue;
    sphere.push_back(point);
    mean += point;
  }
  mean /= static_cast<double>(sphere.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : sphere) covariance += (point - mean) * (point - mean).transpose();
  covariance /= static_cast<double>(sphere.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return {solver.eigenvalues(), solver.eigenvectors().col(0), sphere.size()};
}

void expect_like_reference(const Points& points, double radius) {
  const LocalPca pca = pca_of(points, radius);
  ASSERT_EQ(pca.curvature.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Reference r = reference_at(points, i, radius);
    ASSERT_EQ(pca.neighbours[i], r.neighbours) << "point " << i;
    const auto& l = r.eigenvalues;
    ASSERT_NEAR(pca.normals[i].norm(), 1.0, 1e-5) << "point " << i;
    if (l[1] <= 1e-3 * l[2]) continue;  // a point or about a line: the ratios below are rounding
    ASSERT_NEAR(pca.curvature[i], l[0] / l.sum(), 1e-5) << "point " << i;
    ASSERT_NEAR(pca.ratio21[i], l[1] / l[2], 1e-4) << "point " << i;
    ASSERT_NEAR(pca.ratio32[i], l[0] / l[1], 1e-3) << "point " << i;
    if (l[0] > 0.8 * l[1]) continue;  // about any direction across l1 is a normal
    ASSERT_GT(std::abs(pca.normals[i].cast<double>().dot(r.normal)), 1 - 1e-5) << "point " << i;
  }
}

TEST(LocalPca, AgreesWithEigenOnASurface) {
  Random random(1);
  const BumpySurface shape(random);
  for (const double radius : {0.4, 1.0}) expect_like_reference(shape.sample(random, 1500, 4), radius);
}

TEST(LocalPca, AgreesWithEigenInAVolume) {
  Random random(2);
  expect_like_reference(testing::random_points(random, 1000, 2), 0.7);
}

TEST(LocalPca, AgreesWithEigenFarFromTheOrigin) {
  Random random(3);
  const BumpySurface shape(random);
  Points points = shape.sample(random, 1000, 4);
  const Eigen::Vector3d shift(256, -512, 64);
  for (Eigen::Vector3d& point : points) point = (point + shift).cast<float>().cast<double>();  // what the grid holds
  expect_like_reference(points, 1.0);
}

TEST(LocalPca, DoesNotDependOnTheCells) {
  Random random(4);
  const Points points = testing::random_points(random, 500, 2);
  const LocalPca fine = local_pca(PointGrid(points, 0.2), 0.8, 1);
  const LocalPca coarse = local_pca(PointGrid(points, 3.0), 0.8, 1);
  EXPECT_EQ(fine.neighbours, coarse.neighbours);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(fine.curvature[i], coarse.curvature[i], 1e-5);
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(LocalPca, IsBitIdenticalForEveryThreadCount) {
  Random random(5);
  const BumpySurface shape(random);
  const Points points = shape.sample(random, 3000, 5);
  const LocalPca one = pca_of(points, 0.5, 1);
  for (const int threads : {0, 2, 4}) {
    const LocalPca many = pca_of(points, 0.5, threads);
    EXPECT_TRUE(same_bits(one.curvature, many.curvature) && same_bits(one.ratio21, many.ratio21) &&
                same_bits(one.ratio32, many.ratio32) && same_bits(one.neighbours, many.neighbours) &&
                same_bits(one.normals, many.normals))
        << threads << " threads";
  }
}

TEST(LocalPca, OfAPlane) {
  Random random(6);
  const Transformation pose = random.motion(5);
  Points points;
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-3, 3);
    points.push_back(pose * Eigen::Vector3d(x, random.uniform(-3, 3), 0));
  }
  const LocalPca pca = pca_of(points, 1.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(pca.curvature[i], 0, 1e-6);
    EXPECT_GT(std::abs(pca.normals[i].cast<double>().dot(pose.linear().col(2))), 1 - 1e-5);
  }
}

TEST(LocalPca, OfALine) {
  Random random(7);
  const Eigen::Vector3d along = random.direction();
  Points points;
  for (int i = 0; i < 200; ++i) points.push_back(random.uniform(-5, 5) * along);
  const LocalPca pca = pca_of(points, 1.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(pca.curvature[i], 0, 1e-6);
    EXPECT_NEAR(pca.ratio21[i], 0, 1e-6);
    EXPECT_NEAR(pca.normals[i].norm(), 1, 1e-5);
    EXPECT_NEAR(pca.normals[i].cast<double>().dot(along), 0, 1e-3);
  }
}

TEST(LocalPca, OfOnePlaceHasNoShape) {
  for (const std::size_t copies : {1, 5}) {
    const LocalPca pca = pca_of(Points(copies, Eigen::Vector3d(0.3, -0.7, 1.1)), 1.0);
    for (std::size_t i = 0; i < copies; ++i) {
      EXPECT_EQ(pca.neighbours[i], copies);
      EXPECT_EQ(pca.curvature[i], 0);
      EXPECT_EQ(pca.ratio21[i], 0);
      EXPECT_EQ(pca.ratio32[i], 0);
      EXPECT_NEAR(pca.normals[i].norm(), 1, 1e-6);
    }
  }
}

TEST(LocalPca, CurvatureIsASurfaceVariation) {
  Random random(8);
  const LocalPca pca = pca_of(testing::random_points(random, 1000, 1), 0.3);
  for (std::size_t i = 0; i < pca.curvature.size(); ++i) {
    EXPECT_GE(pca.curvature[i], 0);
    EXPECT_LE(pca.curvature[i], 1.0f / 3 + 1e-6f);
    EXPECT_LE(pca.ratio21[i], 1 + 1e-6f);
    EXPECT_LE(pca.ratio32[i], 1 + 1e-6f);
  }
}

TEST(LocalNormal, IsThatOfTheSphereAroundAnyPlace) {
  Random random(9);
  const BumpySurface shape(random);
  const Points points = shape.sample(random, 1500, 4);
  const PointGrid grid(points, 0.5);
  const LocalPca pca = local_pca(grid, 0.8, 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d normal = local_normal(grid, points[i].cast<float>(), 0.8);
    ASSERT_NEAR(normal.norm(), 1, 1e-5);
    if (pca.neighbours[i] < 4 || pca.ratio32[i] > 0.8) continue;
    ASSERT_GT(std::abs(normal.dot(pca.normals[i].cast<double>())), 1 - 1e-5) << "point " << i;
  }
  EXPECT_NEAR(local_normal(grid, Eigen::Vector3f(100, 100, 100), 0.8).norm(), 1, 1e-6);
}

// Within one scan line every normal across it would fit.
TEST(LocalNormal, OfScanLinesIsThatOfTheSurfaceTheyLieOn) {
  Random random(10);
  const Eigen::Vector3d normal = random.direction(), along = normal.unitOrthogonal(), across = normal.cross(along);
  Points points;
  for (int line = -5; line <= 5; ++line) {
    for (int i = -60; i <= 60; ++i) points.push_back(0.5 * line * across + 0.05 * i * along);
  }
  const PointGrid grid(points, 0.2);
  for (const Eigen::Vector3d& point : points) {
    ASSERT_GT(std::abs(local_normal(grid, point.cast<float>(), 0.3).dot(normal)), 0.999) << point.transpose();
  }
}

// Nothing but one line within reach: some normal of it, and an end to the search.
TEST(LocalNormal, OfOneLineLiesAcrossIt) {
  Points points;
  for (int i = 0; i < 50; ++i) points.emplace_back(0.1 * i, 0, 0);
  const PointGrid grid(points, 0.2);
  const Eigen::Vector3d normal = local_normal(grid, points[20].cast<float>(), 0.3);
  EXPECT_NEAR(normal.norm(), 1, 1e-6);
  EXPECT_NEAR(normal.x(), 0, 1e-3);
}

TEST(LocalPca, OfNoPointsIsEmpty) {
  EXPECT_TRUE(pca_of({}, 1.0).curvature.empty());
}

}  // namespace
}  // namespace igsp
