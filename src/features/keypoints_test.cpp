#include "features/keypoints.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using testing::BumpySurface;
using testing::Random;

constexpr double voxel_size = 0.1;

struct Scene {
  Points points;
  KeypointOptions options;
  PointGrid grid;
  LocalPca pca;
  std::vector<std::uint32_t> keypoints;

  Scene(Points scene_points, const KeypointOptions& keypoint_options)
      : points(std::move(scene_points)),
        options(keypoint_options),
        grid(points, 0.5 * options.pca_radius * voxel_size),
        pca(local_pca(grid, options.pca_radius * voxel_size, 1)),
        keypoints(detect_keypoints(points, grid, pca, voxel_size, options)) {}

  bool is_candidate(std::size_t i) const {
    return pca.ratio21[i] < options.max_eigenvalue_ratio && pca.ratio32[i] < options.max_eigenvalue_ratio &&
           pca.neighbours[i] > static_cast<unsigned>(options.min_neighbours) &&
           pca.curvature[i] >= options.min_curvature;
  }
  double distance(std::size_t a, std::size_t b) const { return (points[a] - points[b]).norm(); }
  double suppression_radius() const { return options.suppression_radius * voxel_size; }
};

Points bumpy(Random& random, std::size_t size = 1200) {
  const BumpySurface shape(random);
  return shape.sample(random, size, 2.0);
}

Scene random_scene(std::uint64_t seed) {
  Random random(seed);
  KeypointOptions options;
  options.pca_radius = random.uniform(3, 7);
  options.suppression_radius = random.uniform(1, 6);
  options.max_eigenvalue_ratio = random.uniform(0.6, 1);
  options.min_neighbours = random.integer(3, 30);
  options.min_curvature = random.uniform(0, 0.05);
  return Scene(bumpy(random), options);
}

constexpr double rounding = 1e-6;  // the grid holds single precision

TEST(Keypoints, PassEveryThresholdAndComeBestFirst) {
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = random_scene(seed);
    found += scene.keypoints.size();
    for (std::size_t k = 0; k < scene.keypoints.size(); ++k) {
      EXPECT_TRUE(scene.is_candidate(scene.keypoints[k]));
      if (k == 0) continue;
      const std::uint32_t before = scene.keypoints[k - 1], here = scene.keypoints[k];
      EXPECT_TRUE(scene.pca.curvature[before] > scene.pca.curvature[here] ||
                  (scene.pca.curvature[before] == scene.pca.curvature[here] && before < here));
    }
  }
  EXPECT_GT(found, 100u) << "the scenes have too few keypoints for this test to say anything";
}

RC_GTEST_PROP(Keypoints, AreFartherApartThanTheSuppressionRadius, (std::uint64_t seed)) {
  const Scene scene = random_scene(seed);
  for (const std::uint32_t a : scene.keypoints) {
    for (const std::uint32_t b : scene.keypoints) {
      RC_ASSERT(a == b || scene.distance(a, b) > scene.suppression_radius() - rounding);
    }
  }
}

RC_GTEST_PROP(Keypoints, SuppressOnlyWhatIsWorseAndNear, (std::uint64_t seed)) {
  const Scene scene = random_scene(seed);
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    if (!scene.is_candidate(i)) continue;
    RC_ASSERT(std::any_of(scene.keypoints.begin(), scene.keypoints.end(), [&](std::uint32_t k) {
      return scene.pca.curvature[k] >= scene.pca.curvature[i] &&
             scene.distance(k, i) <= scene.suppression_radius() + rounding;
    }));
  }
}

TEST(Keypoints, HaveMoreNeighboursThanTheMinimum) {
  Random random(1);
  const Points points = bumpy(random);
  KeypointOptions options;
  options.min_neighbours = 0;
  const Scene all(points, options);
  const std::uint32_t most = *std::max_element(all.pca.neighbours.begin(), all.pca.neighbours.end());
  ASSERT_FALSE(all.keypoints.empty());
  options.min_curvature = 0;
  options.min_neighbours = static_cast<int>(most);
  EXPECT_TRUE(Scene(points, options).keypoints.empty());
  options.min_neighbours = static_cast<int>(most) - 1;
  EXPECT_FALSE(Scene(points, options).keypoints.empty());
}

TEST(Keypoints, OfEqualCurvatureTheFirstWins) {
  const Points points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {9, 0, 0}};
  const PointGrid grid(points, 1.0);
  LocalPca pca;
  pca.curvature = {0.1f, 0.1f, 0.1f, 0.2f};
  pca.ratio21 = pca.ratio32 = {0.5f, 0.5f, 0.5f, 0.5f};
  pca.neighbours = {50, 50, 50, 50};
  KeypointOptions options;
  options.suppression_radius = 1.5;
  EXPECT_EQ(detect_keypoints(points, grid, pca, 1.0, options), (std::vector<std::uint32_t>{3, 0, 2}));
  options.suppression_radius = 1.0;  // points at this distance are suppressed
  EXPECT_EQ(detect_keypoints(points, grid, pca, 1.0, options), (std::vector<std::uint32_t>{3, 0, 2}));
  options.suppression_radius = 0.9;
  EXPECT_EQ(detect_keypoints(points, grid, pca, 1.0, options), (std::vector<std::uint32_t>{3, 0, 1, 2}));
}

TEST(Keypoints, APlaneAndALineHaveNone) {
  Random random(2);
  const Transformation pose = random.motion(3);
  Points plane, line;
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(-2, 2);
    plane.push_back(pose * Eigen::Vector3d(x, random.uniform(-2, 2), 0));
    line.push_back(pose * Eigen::Vector3d(x, 0, 0));
  }
  KeypointOptions options;
  options.min_curvature = 1e-4;
  EXPECT_TRUE(Scene(plane, options).keypoints.empty());
  EXPECT_TRUE(Scene(line, options).keypoints.empty());
}

TEST(Keypoints, OfNoPointsAreNone) {
  EXPECT_TRUE(Scene({}, {}).keypoints.empty());
}

}  // namespace
}  // namespace igsp
