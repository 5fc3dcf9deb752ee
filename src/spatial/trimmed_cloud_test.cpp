#include "spatial/trimmed_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "igsp/align.hpp"
#include "igsp/simulation.hpp"

namespace igsp {
namespace {

Points cube_of(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(0.0, 1.0);
  Points points(count);
  for (Eigen::Vector3d& point : points) point = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

Points with(Points points, std::initializer_list<Eigen::Vector3d> strays) {
  points.insert(points.begin() + points.size() / 2, strays);
  return points;
}

TEST(TrimmedCloud, RefersToAnOrdinaryCloud) {
  const Points cube = cube_of(1000);
  const TrimmedCloud trimmed(cube, "cloud");
  EXPECT_EQ(trimmed.stray().count, 0u);
  EXPECT_EQ(trimmed.points().data(), cube.data());
}

TEST(TrimmedCloud, LeavesOutFarPointsAtAnyDistance) {
  const Points cube = cube_of(1000);
  const Bounds bounds = bounds_of(cube, "cube");
  for (const double distance : {2.0, 30.0, 1e4, 1e9, 1e100}) {
    const Points cloud = with(cube, {{distance, 0.5, 0.5}, {0.5, -2 * distance, 0.5}, {0.5, 0.5, 5 * distance}});
    const TrimmedCloud trimmed(cloud, "cloud");
    EXPECT_EQ(trimmed.stray().count, 3u) << distance;
    EXPECT_EQ(trimmed.bounds().min, bounds.min) << distance;
    EXPECT_EQ(trimmed.bounds().max, bounds.max) << distance;
    EXPECT_TRUE(std::ranges::equal(trimmed.points(), cube)) << distance;
    EXPECT_NEAR(trimmed.stray().extents_away / ((5 * distance - 1) / bounds.diagonal()), 1, 0.02) << distance;
  }
}

TEST(TrimmedCloud, KeepsWhatIsMoreThanAFewPoints) {
  Points cloud = cube_of(1000);
  for (int i = 0; i < 30; ++i) cloud.emplace_back(5 + 0.01 * i, 5, 5);
  EXPECT_EQ(TrimmedCloud(cloud, "cloud").stray().count, 0u);
}

TEST(TrimmedCloud, KeepsPointsThatAreNear) {
  EXPECT_EQ(TrimmedCloud(with(cube_of(1000), {{1.3, 0.5, 0.5}}), "cloud").stray().count, 0u);
}

TEST(TrimmedCloud, TakesCloudsWithoutExtentAlongAnAxis) {
  Points cloud(500, Eigen::Vector3d(1, 2, 3));
  cloud.resize(1000, Eigen::Vector3d(8, 2, 3));
  EXPECT_EQ(TrimmedCloud(cloud, "cloud").stray().count, 0u);
  cloud.resize(500);
  cloud.emplace_back(8, 2, 3);  // what would stay is one place
  EXPECT_EQ(TrimmedCloud(cloud, "cloud").stray().count, 0u);
}

TEST(TrimmedCloud, DoesNotDependOnTheOrder) {
  Points cloud = with(cube_of(1000), {{3, 0, 0}, {0, 1e6, 0}});
  const TrimmedCloud before(cloud, "cloud");
  std::shuffle(cloud.begin(), cloud.end(), std::mt19937(1));
  const TrimmedCloud after(cloud, "cloud");
  EXPECT_EQ(before.stray().count, after.stray().count);
  EXPECT_EQ(before.stray().extents_away, after.stray().extents_away);
  EXPECT_EQ(before.bounds().min, after.bounds().min);
  EXPECT_EQ(before.bounds().max, after.bounds().max);
}

TEST(TrimmedCloud, OneStrayPointChangesNoBitOfTheAnswer) {
  const auto scans = simulate("park", {.points = 20000, .seed = 3});
  const SimulatedScan &source = scans[1], &target = scans[0];
  const Result clean = align(source.points, target.points);
  ASSERT_TRUE(clean.registered);
  const double size = bounds_of(source.points, "source").diagonal();
  for (const double extents : {2.0, 10.0, 1e6}) {
    const Eigen::Vector3d stray = source.points[0] + extents * size * Eigen::Vector3d(0.6, -0.64, 0.48);
    for (const bool in_source : {true, false}) {
      const Points moved = in_source ? with(source.points, {stray}) : source.points;
      const Points fixed = in_source ? target.points : with(target.points, {stray});
      const Result result = align(moved, fixed);
      EXPECT_EQ(result.target_from_source.matrix(), clean.target_from_source.matrix()) << extents;
      EXPECT_EQ(result.confidence, clean.confidence) << extents;
      const CloudSummary& summary = in_source ? result.source : result.target;
      EXPECT_EQ(summary.stray.count, 1u);
      EXPECT_GT(summary.stray.extents_away, 0.5 * extents);
    }
  }
}

}  // namespace
}  // namespace igsp
