#include "spatial/point_grid.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using testing::Random;

/// Generic points, or a lattice full of duplicates, of ties and of points on the very rim of a sphere.
Points random_cloud(Random& random) {
  Points points = testing::random_points(random, random.integer(1, 300), random.uniform(0.5, 6));
  if (random.integer(0, 1) == 0) {
    const double step = random.integer(0, 1) == 0 ? 0.5 : 0.1;
    for (Eigen::Vector3d& point : points) point = (point / step).array().round() * step;
  }
  return points;
}

Eigen::Vector3f random_query(Random& random, const Points& points) {
  switch (random.integer(0, 4)) {
    case 0:
      return points[random.bits() % points.size()].cast<float>();
    case 1:
      return random.in_cube(100).cast<float>();  // mostly far outside
    case 2:
      return (random.in_cube(6) * 4).array().round().cast<float>() * 0.25f;  // equally near to many of a lattice
    default:
      return random.in_cube(7).cast<float>();
  }
}

float random_radius(Random& random) {
  constexpr float round_radii[] = {0.1f, 0.5f, 1.0f, 2.0f, 50.0f};
  return random.integer(0, 1) == 0 ? round_radii[random.integer(0, 4)] : static_cast<float>(random.uniform(0.05, 8));
}

float squared_distance(const Eigen::Vector3d& point, const Eigen::Vector3f& centre) {
  const float dx = static_cast<float>(point.x()) - centre.x(), dy = static_cast<float>(point.y()) - centre.y(),
              dz = static_cast<float>(point.z()) - centre.z();
  return dx * dx + dy * dy + dz * dz;
}

using Found = std::vector<std::pair<std::uint32_t, float>>;

RC_GTEST_PROP(PointGrid, FindsExactlyThePointsOfASphere, (std::uint64_t seed)) {
  Random random(seed);
  const Points points = random_cloud(random);
  const PointGrid grid(points, random.uniform(0.05, 5));
  for (int query = 0; query < 20; ++query) {
    const Eigen::Vector3f centre = random_query(random, points);
    const float radius = random_radius(random);
    Found found, expected;
    grid.visit_sphere(centre, radius,
                      [&](std::uint32_t i, float squared) { found.emplace_back(grid.index[i], squared); });
    std::sort(found.begin(), found.end());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const float squared = squared_distance(points[i], centre);
      if (squared <= radius * radius) expected.emplace_back(i, squared);
    }
    RC_ASSERT(found == expected);
  }
}

RC_GTEST_PROP(PointGrid, FindsTheNearestAndOfEquallyNearOnesTheFirst, (std::uint64_t seed)) {
  Random random(seed);
  const Points points = random_cloud(random);
  const PointGrid grid(points, random.uniform(0.05, 5));
  for (int query = 0; query < 20; ++query) {
    const Eigen::Vector3f centre = random_query(random, points);
    const float radius = random_radius(random);
    std::int64_t expected = -1;
    float best = radius * radius;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const float squared = squared_distance(points[i], centre);
      if (squared < best || (squared == best && expected < 0)) {
        best = squared;
        expected = i;
      }
    }
    RC_ASSERT(grid.nearest(centre, radius) == expected);
    if (expected < 0) continue;
    const float hardly_more = std::min(radius, 1.0001f * std::sqrt(best));
    RC_ASSERT(grid.nearest_within(centre, hardly_more) == expected);
  }
}

RC_GTEST_PROP(PointGrid, HoldsEveryPointInItsCell, (std::uint64_t seed)) {
  Random random(seed);
  const Points points = random_cloud(random);
  const PointGrid grid(points, random.uniform(0.05, 5));
  RC_ASSERT(grid.size() == points.size());
  std::vector<std::uint32_t> sorted = grid.index;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t i = 0; i < points.size(); ++i) RC_ASSERT(sorted[i] == i);
  RC_ASSERT(grid.start.size() == grid.cell_number(0, 0, grid.cells[2]) + 1);
  RC_ASSERT(grid.start.back() == points.size());
  for (std::size_t cell = 0; cell + 1 < grid.start.size(); ++cell) {
    for (std::uint32_t i = grid.start[cell]; i < grid.start[cell + 1]; ++i) {
      const Eigen::Vector3f point(grid.x[i], grid.y[i], grid.z[i]);
      RC_ASSERT(point == points[grid.index[i]].cast<float>());
      const auto c = grid.cell_of(point);
      RC_ASSERT(grid.cell_number(c[0], c[1], c[2]) == cell);
    }
  }
}

TEST(PointGrid, OfNoPointsFindsNone) {
  const PointGrid grid(Points{}, 1.0);
  EXPECT_EQ(grid.size(), 0u);
  EXPECT_EQ(grid.nearest(Eigen::Vector3f::Zero(), 100.0f), -1);
  grid.visit_sphere(Eigen::Vector3f::Zero(), 100.0f, [](std::uint32_t, float) { FAIL(); });
}

TEST(PointGrid, ReachesBeyondEveryFace) {
  const Points points{{-1, -1, -1}, {1, 1, 1}};
  const PointGrid grid(points, 0.25);
  EXPECT_EQ(grid.nearest({-1e6f, -1e6f, -1e6f}, 1e7f), 0);
  EXPECT_EQ(grid.nearest({1e6f, 1e6f, 1e6f}, 1e7f), 1);
  EXPECT_EQ(grid.nearest({1e6f, 1e6f, 1e6f}, 1e5f), -1);
}

TEST(PointGrid, SparseCloudsCostNoMemoryForEmptyCells) {
  Random random(3);
  const Points points = testing::random_points(random, 50, 1e5);
  const PointGrid grid(points, 0.001);
  EXPECT_LE(grid.start.size(), 4'000'001u);
  for (std::uint32_t i = 0; i < points.size(); ++i) EXPECT_EQ(grid.nearest(points[i].cast<float>(), 1.0f), i);
}

}  // namespace
}  // namespace igsp
