#include "igsp/features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <string>

#include "core/core_testing.hpp"
#include "features/extraction.hpp"
#include "features/features_testing.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

using testing::BumpySurface;
using testing::Random;

constexpr double voxel_size = 0.1;

Options feature_options() {
  Options options;
  options.threads = 1;
  options.scale.voxel_size = voxel_size;
  return options;
}

/// Coordinates are multiples of 2^-12, so that shifts by whole metres are exact.
Points cloud(std::uint64_t seed) {
  Random random(seed);
  const BumpySurface shape(random);
  Points points = shape.sample(random, 20000, 3);
  for (Eigen::Vector3d& point : points) point = (point * 4096).array().round() / 4096;
  return points;
}

void expect_same(const Features& a, const Features& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.fine_points, b.fine_points);
  EXPECT_EQ(a.curvature, b.curvature);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.keypoints, b.keypoints);
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_EQ(a.descriptors, b.descriptors);
  ASSERT_EQ(a.coarser.size(), b.coarser.size());
  for (std::size_t k = 0; k < a.coarser.size(); ++k) expect_same(a.coarser[k], b.coarser[k]);
}

TEST(ExtractFeatures, DescribesOneCloud) {
  const Points points = cloud(1);
  const Features features = extract_features(points, feature_options());
  EXPECT_EQ(features.cloud_points, points.size());
  EXPECT_EQ(features.voxel_size, voxel_size);
  EXPECT_EQ(features.curvature.size(), features.points.size());
  EXPECT_EQ(features.normals.size(), features.points.size());
  ASSERT_GT(features.keypoints.size(), 20u);
  EXPECT_EQ(features.frames.size(), features.keypoints.size());
  EXPECT_EQ(features.descriptors.size(), features.keypoints.size());
  for (const Eigen::Vector3d& normal : features.normals) EXPECT_NEAR(normal.norm(), 1, 1e-5);
  for (const Eigen::Matrix3d& frame : features.frames) {
    EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  }
  for (std::size_t k = 1; k < features.keypoints.size(); ++k) {
    EXPECT_GE(features.curvature[features.keypoints[k - 1]], features.curvature[features.keypoints[k]]);
  }
  const std::set<Descriptor> distinct(features.descriptors.begin(), features.descriptors.end());
  EXPECT_EQ(distinct.size(), features.descriptors.size());
  ASSERT_FALSE(features.timings_s.empty());
  for (const auto& [stage, seconds] : features.timings_s) EXPECT_GE(seconds, 0) << stage;
}

TEST(ExtractFeatures, PointsAreLocalAndOriginBringsThemBack) {
  const Points points = cloud(2);
  const Features features = extract_features(points, feature_options());
  double farthest = 0;
  for (std::size_t i = 0; i < features.points.size(); i += 50) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& point : points) {
      nearest = std::min(nearest, (point - features.origin - features.points[i]).norm());
    }
    farthest = std::max(farthest, nearest);
  }
  EXPECT_LT(farthest, voxel_size) << "a voxel centroid lies where no point of the cloud is";
}

TEST(ExtractFeatures, SurveyCoordinatesLoseNothing) {
  const Points points = cloud(3);
  const Eigen::Vector3d shift(500000, 5000000, 100);
  Points shifted = points;
  for (Eigen::Vector3d& point : shifted) point += shift;
  const Features here = extract_features(points, feature_options());
  const Features there = extract_features(shifted, feature_options());
  expect_same(here, there);
  EXPECT_EQ(there.origin, here.origin + shift);
}

TEST(ExtractFeatures, AreBitIdenticalForEveryThreadCount) {
  const Points points = cloud(4);
  Options options = feature_options();
  const Features one = extract_features(points, options);
  for (const int threads : {0, 2, 4}) {
    options.threads = threads;
    expect_same(one, extract_features(points, options));
  }
}

TEST(ExtractFeatures, ChoosesTheVoxelSizeWhenNoneIsGiven) {
  Options options = feature_options();
  options.scale.voxel_size = 0;
  options.scale.target_points = 3000;
  const Features features = extract_features(cloud(5), options);
  EXPECT_NEAR(static_cast<double>(features.points.size()), 3000, 150);
}

TEST(ExtractFeatures, LevelledFramesStandUpright) {
  Options options = feature_options();
  options.degrees_of_freedom = 4;
  const Features features = extract_features(cloud(6), options);
  ASSERT_FALSE(features.frames.empty());
  for (const Eigen::Matrix3d& frame : features.frames) EXPECT_EQ(frame.col(2), Eigen::Vector3d::UnitZ());
}

TEST(ExtractFeatures, FindNoKeypointsOnCloudsWithoutShape) {
  Random random(7);
  Points line;
  for (int i = 0; i < 1000; ++i) line.emplace_back(random.uniform(0, 10), 0, 0);
  for (const Points& points : {Points{{1, 2, 3}}, Points(1000, Eigen::Vector3d(1, 2, 3)), line}) {
    const Features features = extract_features(points, feature_options());
    EXPECT_TRUE(features.keypoints.empty());
    EXPECT_FALSE(features.points.empty());
    for (const Eigen::Vector3d& normal : features.normals) EXPECT_NEAR(normal.norm(), 1, 1e-5);
  }
}

TEST(ExtractFeatures, TakesManyPointsAtTwoPlaces) {
  Points points(50000, Eigen::Vector3d(1, 2, 3));
  points.resize(100000, Eigen::Vector3d(8, 2, 3));
  Options options = feature_options();
  options.scale.voxel_size = 0;
  EXPECT_EQ(extract_features(points, options).points.size(), 2u);
}

TEST(CoarserVoxels, OfSeveralScansKnowWhoSawThem) {
  const Points points = cloud(6);
  Scan scan(points);
  scan.parts = {{8000, Eigen::Vector3d(0, 0, 5)}, {points.size() - 8000, Eigen::Vector3d(1, 2, 5)}};
  const Features fine = extract_features(scan, feature_options()), coarse = coarser_voxels(fine);
  ASSERT_EQ(coarse.parts.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(coarse.parts[i].viewpoint, fine.parts[i].viewpoint);
    EXPECT_LT(coarse.parts[i].fine_points.size(), fine.parts[i].fine_points.size());
    EXPECT_GT(coarse.parts[i].fine_points.size(), 100u);
  }
}

TEST(CoarserVoxels, AreDescribedAsFarAsThereAreEnough) {
  const Features features = extract_features(cloud(9), feature_options());
  ASSERT_GE(features.coarser.size(), 1u);
  ASSERT_LT(features.coarser.size(), most_scales);
  const Features* finer = &features;
  for (const Features& coarser : features.coarser) {
    EXPECT_GE(finer->points.size(), enough_voxels_for_coarser);
    EXPECT_EQ(coarser.voxel_size, 2 * finer->voxel_size);
    EXPECT_EQ(coarser.points, coarser_voxels(*finer).points);
    EXPECT_EQ(coarser.descriptors.size(), coarser.keypoints.size());
    EXPECT_FALSE(coarser.keypoints.empty());
    EXPECT_TRUE(coarser.coarser.empty());
    finer = &coarser;
  }
  EXPECT_TRUE(features.coarser.size() + 1 == most_scales || finer->points.size() < enough_voxels_for_coarser);
}

TEST(ExtractFeatures, RefusesWhatIsNoCloud) {
  EXPECT_THROW(extract_features(Points{}, feature_options()), InvalidArgument);
  Points points = cloud(8);
  points[17].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(extract_features(points, feature_options()), InvalidArgument);
  Options options = feature_options();
  options.descriptor.radius = -1;
  EXPECT_THROW(extract_features(cloud(8), options), InvalidArgument);
  options = feature_options();
  options.scale.voxel_size = 1e-9;
  EXPECT_THROW(extract_features(cloud(8), options), InvalidArgument);
}

TEST(ExtractFeatures, ReportsAndStops) {
  const Points points = cloud(9);
  std::size_t calls = 0;
  const Features features = extract_features(points, feature_options(), [&](const Progress& progress) {
    EXPECT_FALSE(progress.stage.empty());
    EXPECT_GE(progress.fraction, 0);
    EXPECT_LE(progress.fraction, 1);
    ++calls;
    return true;
  });
  ASSERT_GE(calls, 2 * features.timings_s.size());
  for (const std::size_t stop_at : {std::size_t{0}, calls / 2, calls - 1}) {
    std::size_t call = 0;
    EXPECT_THROW(extract_features(points, feature_options(), [&](const Progress&) { return call++ != stop_at; }),
                 Cancelled);
  }
}

}  // namespace
}  // namespace igsp
