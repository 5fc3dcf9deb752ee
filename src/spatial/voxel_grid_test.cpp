#include "spatial/voxel_grid.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "core/core_testing.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

using testing::Random;

struct Case {
  Points points;
  Eigen::Vector3d origin;
  double voxel_size;
};

Case random_case(Random& random) {
  Case c;
  c.points = testing::random_points(random, random.integer(0, 400), random.uniform(0.5, 20));
  c.origin = random.in_cube(10);
  c.voxel_size = random.uniform(0.3, 5);
  return c;
}

/// The specification, plainly: mean of the points of every cell, in the order of (z, y, x) of the cells.
Points plain_centroids(const Case& c) {
  struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
  };
  std::map<std::array<double, 3>, Cell> cells;
  for (const Eigen::Vector3d& point : c.points) {
    const Eigen::Vector3d local = point - c.origin;
    const Eigen::Vector3d i = (local / c.voxel_size).array().floor();
    Cell& cell = cells[{i.z(), i.y(), i.x()}];
    cell.sum += local;
    ++cell.count;
  }
  Points centroids;
  for (const auto& [key, cell] : cells) centroids.push_back(cell.sum / cell.count);
  return centroids;
}

bool near(const Points& a, const Points& b, double tolerance) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [&](const auto& p, const auto& q) { return (p - q).norm() <= tolerance; });
}

RC_GTEST_PROP(VoxelFilter, GivesTheCentroidOfEveryVoxelInOrder, (std::uint64_t seed)) {
  Random random(seed);
  const Case c = random_case(random);
  RC_ASSERT(near(voxel_centroids(c.points, c.origin, c.voxel_size), plain_centroids(c), 1e-12));
}

RC_GTEST_PROP(VoxelFilter, DoesNotSeeHowTheCloudWasCut, (std::uint64_t seed)) {
  Random random(seed);
  const Case c = random_case(random);
  std::size_t begin = 0;
  const ChunkSource chunks = [&]() -> PointView {
    const std::size_t size = std::min<std::size_t>(random.integer(1, 50), c.points.size() - begin);
    begin += size;
    return PointView(c.points).subspan(begin - size, size);
  };
  RC_ASSERT(voxel_centroids(chunks, c.origin, c.voxel_size) == voxel_centroids(c.points, c.origin, c.voxel_size));
}

RC_GTEST_PROP(VoxelFilter, DoesNotSeeTheOrderOfThePoints, (std::uint64_t seed)) {
  Random random(seed);
  Case c = random_case(random);
  const Points ordered = voxel_centroids(c.points, c.origin, c.voxel_size);
  for (std::size_t i = c.points.size(); i > 1; --i) std::swap(c.points[i - 1], c.points[random.bits() % i]);
  RC_ASSERT(voxel_centroids(c.points, c.origin, c.voxel_size) == ordered);
}

TEST(VoxelFilter, MorePointsThan64BitsSumUp) {
  const std::size_t count = std::size_t{3} << 21;  // of up to 2^42 steps each: beyond 2^64 along x and z, not along y
  const Points points(1 << 16, Eigen::Vector3d(0.75, 0.25, 0.9999));
  VoxelFilter filter(Eigen::Vector3d::Zero(), 1.0);
  for (std::size_t left = count; left > 0;) {
    const std::size_t now = std::min(left, points.size());
    filter.add(PointView(points).first(now));
    left -= now;
  }
  EXPECT_LT((filter.centroids().at(0) - points[0]).norm(), 1e-12);
}

TEST(VoxelFilter, HundredThousandVoxels) {
  Random random(1);
  std::set<std::array<int, 3>> chosen;
  while (chosen.size() < 100000) {
    const int x = random.integer(-300, 300), y = random.integer(-300, 300);
    chosen.insert({random.integer(-300, 300), y, x});
  }
  Points points;
  for (const auto& [z, y, x] : chosen) points.emplace_back(x + 0.5, y + 0.5, z + 0.5);
  Points shuffled = points;
  for (std::size_t i = shuffled.size(); i > 1; --i) std::swap(shuffled[i - 1], shuffled[random.bits() % i]);
  VoxelFilter filter(Eigen::Vector3d::Zero(), 1.0);
  filter.add(shuffled);
  EXPECT_EQ(filter.size(), points.size());
  EXPECT_EQ(filter.centroids(), points);
}

TEST(VoxelFilter, VoxelsOnBothSidesOfTheOriginAreDifferentOnes) {
  const Points points{{-0.5, 0, 0}, {0.5, 0, 0}};
  EXPECT_EQ(voxel_centroids(points, Eigen::Vector3d::Zero(), 1.0).size(), 2u);
  EXPECT_EQ(voxel_centroids(points, Eigen::Vector3d(-1, 0, 0), 2.0).size(), 1u);
}

TEST(VoxelFilter, AMillionDuplicatesAreOnePoint) {
  const Eigen::Vector3d point(12.34, -56.78, 9.1);
  const Points points(1'000'000, point);
  const Points centroids = voxel_centroids(points, Eigen::Vector3d::Zero(), 0.5);
  ASSERT_EQ(centroids.size(), 1u);
  EXPECT_LT((centroids[0] - point).norm(), 1e-9);
}

TEST(VoxelFilter, SurveyCoordinatesLoseNothing) {
  Random random(2);
  Points near_points;  // multiples of 2^-12, so that the shift itself is exact
  for (const Eigen::Vector3d& p : testing::random_points(random, 2000, 20)) {
    near_points.push_back((p * 4096).array().round() / 4096);
  }
  const Eigen::Vector3d shift(500000, 5000000, 100), origin(-20, -20, -20);
  Points far_points = near_points;
  for (Eigen::Vector3d& point : far_points) point += shift;
  EXPECT_EQ(voxel_centroids(far_points, origin + shift, 1.7), voxel_centroids(near_points, origin, 1.7));
}

TEST(VoxelFilter, NoPointsNoCentroids) {
  EXPECT_TRUE(voxel_centroids(Points{}, Eigen::Vector3d::Zero(), 1.0).empty());
  EXPECT_TRUE(voxel_centroids(ChunkSource([] { return PointView(); }), Eigen::Vector3d::Zero(), 1.0).empty());
}

std::string error_of(const Points& points, double voxel_size) {
  try {
    voxel_centroids(points, Eigen::Vector3d::Zero(), voxel_size);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "no error";
}

TEST(VoxelFilter, RefusesAVoxelSizeThatIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double size : {0.0, -1.0, nan, infinity}) {
    EXPECT_NE(error_of({}, size).find("voxel_size"), std::string::npos) << size;
  }
  EXPECT_NE(error_of({}, -1.5).find("-1.5"), std::string::npos);
}

TEST(VoxelFilter, RefusesAVoxelSizeTooSmallForTheCloud) {
  const double limit = 1 << 20;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d direction = sign * Eigen::Vector3d::Unit(axis);
      EXPECT_EQ(error_of({(limit - 2) * direction}, 1.0), "no error");
      const std::string error = error_of({(limit + 2) * 0.001 * direction}, 0.001);
      EXPECT_NE(error.find("voxel_size is 0.001"), std::string::npos) << error;
    }
  }
  EXPECT_NE(error_of({{1e300, 0, 0}}, 1.0), "no error");
}

}  // namespace
}  // namespace igsp
