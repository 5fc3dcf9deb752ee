#include "spatial/hull.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using testing::Random;

Points box(const Eigen::Vector3d& size, int count, const Eigen::Matrix3d& rotation) {
  Random random(5);
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(rotation * size.cwiseProduct(random.in_cube(0.5)));
  return points;
}

/// Share of random places of a box, as large again as the hull, that it holds.
double held(const Hull& hull, const Eigen::Vector3d& half_size, const Eigen::Matrix3d& rotation, double margin) {
  Random random(9);
  int count = 0;
  for (int i = 0; i < 4000; ++i) count += hull.holds(rotation * half_size.cwiseProduct(random.in_cube(1)), margin);
  return count / 4000.0;
}

TEST(Hull, HoldsATurnedBoxAndLittleMore) {
  Random random(3);
  const Eigen::Vector3d size(4, 2, 1);
  for (int turn = 0; turn < 10; ++turn) {
    const Eigen::Matrix3d rotation = random.rotation();
    const Points cloud = box(size, 20000, rotation);
    const Hull hull(cloud, bounds_of(cloud, "cloud"));
    EXPECT_GT(held(hull, size / 2, rotation, 0), 0.97) << turn;  // inside
    const double volume = 8 * held(hull, size, rotation, 0);     // in terms of the box
    EXPECT_LT(volume, 1.3) << turn;
    EXPECT_GT(volume, 0.97) << turn;
  }
}

TEST(Hull, MarginLeavesTheSidesOut) {
  const Points cloud = box({1, 1, 1}, 20000, Eigen::Matrix3d::Identity());
  const Hull hull(cloud, bounds_of(cloud, "cloud"));
  EXPECT_FALSE(hull.holds({0.42, 0, 0}, 0.1));
  EXPECT_TRUE(hull.holds({0.38, 0, 0}, 0.1));
}

TEST(Hull, OrderDoesNotMatter) {
  Points cloud = box({1, 1, 1}, 3000, Eigen::Matrix3d::Identity());
  for (Eigen::Vector3d& point : cloud) point = (8 * point).array().round();  // many of the same height
  const Bounds bounds = bounds_of(cloud, "cloud");
  const Hull hull(cloud, bounds);
  std::ranges::reverse(cloud);
  const Hull again(cloud, bounds);
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d place = random.in_cube(5);
    EXPECT_EQ(hull.holds(place), again.holds(place));
  }
}

}  // namespace
}  // namespace igsp
