#include "spatial/scatter_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using testing::Random;

constexpr double side = 10.0;

Points uniform_in_box(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Points points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(random.in_cube(side / 2) + Eigen::Vector3d::Constant(side / 2));
  return points;
}

/// Floor and one wall of the box.
Points two_walls(std::size_t count, std::uint64_t seed) {
  Points points = uniform_in_box(count, seed);
  for (std::size_t i = 0; i < count; ++i) points[i][i % 2 == 0 ? 2 : 0] = 0.01 * points[i][i % 2 == 0 ? 2 : 0];
  return points;
}

Points together(Points a, const Points& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

ScatterFilter filter_of(const Points& cloud, double cell_size) {
  const Bounds bounds = bounds_of(cloud, "cloud");
  return ScatterFilter(cloud, bounds, scattered_noise(cloud, bounds), cell_size);
}

TEST(ScatterFilter, SurfacesAloneAreKept) {
  const Points walls = two_walls(50000, 1);
  EXPECT_TRUE(filter_of(walls, 0.3).keeps_all());
  EXPECT_EQ(without_scatter(walls, filter_of(walls, 0.3)).size(), walls.size());
}

TEST(ScatterFilter, DensityOfTheNoiseIsBounded) {
  const Points cloud = together(two_walls(50000, 1), uniform_in_box(15000, 2));
  const double points = scattered_noise(cloud, bounds_of(cloud, "cloud")).points_in(side);
  EXPECT_GT(points, 0.9 * 15000);
  EXPECT_LT(points, 2.0 * 15000);  // a bound: it holds the walls as well
}

// Beside a partner of ordinary size: the cube of a block is 0 then, and that of the ratio of cell and block infinite.
TEST(ScatterFilter, ACloudAlmostWithoutExtentIsKept) {
  for (Points cloud : {two_walls(50000, 1), together(two_walls(50000, 1), uniform_in_box(15000, 2))}) {
    for (Eigen::Vector3d& point : cloud) point *= 1e-120;
    EXPECT_FALSE(std::isnan(scattered_noise(cloud, bounds_of(cloud, "cloud")).points_in(1.0)));
    EXPECT_TRUE(filter_of(cloud, 1.0).keeps_all());
  }
}

TEST(ScatterFilter, NoiseGoesAndSurfacesStay) {
  const Points walls = two_walls(50000, 1), noise = uniform_in_box(15000, 2);
  for (const double cell_size : {0.3, 0.6}) {
    SCOPED_TRACE(cell_size);
    const ScatterFilter filter = filter_of(together(walls, noise), cell_size);
    ASSERT_FALSE(filter.keeps_all());
    EXPECT_GT(without_scatter(walls, filter).size(), 0.97 * walls.size());
    EXPECT_LT(without_scatter(noise, filter).size(),
              0.15 * noise.size());  // what lies beside a wall cannot be told from it
  }
}

// The box that the noise fills stands at an angle, and fills less than half of the one along the axes.
TEST(ScatterFilter, NoiseGoesWhereverTheCloudIsTurned) {
  Random random(11);
  for (int turn = 0; turn < 5; ++turn) {
    const Eigen::Matrix3d rotation = random.rotation();
    Points walls = two_walls(50000, 1), noise = uniform_in_box(3000, 2);
    for (Points* points : {&walls, &noise}) {
      for (Eigen::Vector3d& point : *points) point = rotation * point;
    }
    const ScatterFilter filter = filter_of(together(walls, noise), 0.8);
    EXPECT_GT(without_scatter(walls, filter).size(), 0.97 * walls.size()) << turn;
    EXPECT_LT(without_scatter(noise, filter).size(), 0.2 * noise.size()) << turn;
  }
}

TEST(ScatterFilter, LengthUnitDoesNotMatter) {
  Points cloud = together(two_walls(20000, 3), uniform_in_box(6000, 4));
  const std::size_t kept = without_scatter(cloud, filter_of(cloud, 0.4)).size();
  for (Eigen::Vector3d& point : cloud) point *= 1024;
  EXPECT_EQ(without_scatter(cloud, filter_of(cloud, 0.4 * 1024)).size(), kept);
}

TEST(ScatterFilter, FlatCountryIsKept) {
  Points terrain = uniform_in_box(20000, 6);
  for (Eigen::Vector3d& point : terrain) {
    point.head<2>() *= 100;
    point.z() = 10 * std::sin(0.01 * point.x()) + 10 * std::cos(0.013 * point.y());
  }
  for (const double cell_size : {10.0, 30.0}) EXPECT_TRUE(filter_of(terrain, cell_size).keeps_all()) << cell_size;
}

TEST(ScatterFilter, DegenerateCloudsAreKept) {
  const Points same(100, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(filter_of(same, 0.1).keeps_all());
  const Points one{{1, 2, 3}};
  EXPECT_TRUE(filter_of(one, 0.1).keeps_all());
  Points line, plane;
  Random random(5);
  for (int i = 0; i < 5000; ++i) {
    line.emplace_back(0.01 * i, 0, 0);
    plane.push_back(random.in_cube(5).cwiseProduct(Eigen::Vector3d(1, 1, 0)));
  }
  EXPECT_TRUE(filter_of(line, 0.1).keeps_all());
  EXPECT_TRUE(filter_of(plane, 0.3).keeps_all());
}

}  // namespace
}  // namespace igsp
