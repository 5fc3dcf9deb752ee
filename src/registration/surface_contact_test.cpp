#include "registration/surface_contact.hpp"

#include <gtest/gtest.h>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using testing::BumpySurface;
using testing::Random;

constexpr double voxel_size = 0.1;

Features features_of(const Scan& scan) {
  Options options;
  options.threads = 1;
  options.scale.voxel_size = voxel_size;
  return extract_features(scan, options);
}

/// Contact of two scans given in one frame, when the first is moved by `motion` first.
SurfaceContact contact(const Scan& moved, const Scan& fixed,
                       const Transformation& motion = Transformation::Identity()) {
  const Features a = features_of(moved), b = features_of(fixed);
  Transformation local = motion;  // between the centred clouds
  local.translation() += motion.linear() * a.origin - b.origin;
  return surface_contact(PreparedCloud(a), PreparedCloud(b), local);
}

struct Scene {
  Random random;
  BumpySurface shape;
  explicit Scene(std::uint64_t seed) : random(seed), shape(random) {}
  Points sample() { return shape.sample(random, 27000, 3); }
};

TEST(SurfaceContact, OfTwoSamplesOfOneSurfaceIsComplete) {
  Scene scene(1);
  const SurfaceContact c = contact(scene.sample(), scene.sample());
  EXPECT_GT(c.share, 0.98);
  EXPECT_LT(c.share, 1);
  EXPECT_GT(c.overlap, 0.97);
}

TEST(SurfaceContact, ShareDoesNotSeeHowFarTheCloudsOverlap) {
  Scene scene(2);
  const Points whole = scene.sample();
  Points half;
  for (const Eigen::Vector3d& point : scene.sample()) {
    if (point.x() > 0) half.push_back(point);
  }
  const SurfaceContact whole_on_half = contact(whole, half), half_on_whole = contact(half, whole);
  EXPECT_GT(whole_on_half.share, 0.95);
  EXPECT_GT(half_on_whole.share, 0.98);
  EXPECT_NEAR(whole_on_half.overlap, 0.5, 0.05);
  EXPECT_GT(half_on_whole.overlap, 0.97);
}

TEST(SurfaceContact, FallsWithTheDistanceOfTheSurfaces) {
  Scene scene(3);
  const Points a = scene.sample(), b = scene.sample();
  const auto lifted = [&](double voxels) {
    return contact(a, b, Transformation(Eigen::Translation3d(0, 0, voxels * voxel_size)));
  };
  const SurfaceContact half = lifted(0.5), three = lifted(3);
  EXPECT_GT(half.share, 0.95);
  EXPECT_LT(three.share, 0.5);
  EXPECT_LT(three.overlap, half.overlap);
}

TEST(SurfaceContact, IsLowWhereSurfacesCross) {
  Scene scene(4);
  const Points a = scene.sample(), b = scene.sample();
  double sum = 0;
  for (int trial = 0; trial < 10; ++trial) {
    Transformation wrong = Transformation::Identity();
    wrong.linear() = scene.random.rotation();
    sum += contact(a, b, wrong).share / 10;
  }
  EXPECT_LT(sum, 0.45);
}

// A thin wall, each side seen from a room of its own: no surface is common to both scans.
TEST(SurfaceContact, TheOtherSideOfAWallIsNotMet) {
  Scene scene(7);
  Points front = scene.sample(), back = scene.sample();
  for (Eigen::Vector3d& point : back) point.z() -= 0.8 * voxel_size;
  const Eigen::Vector3d above(0, 0, 100), below(0, 0, -100);
  const SurfaceContact unknown = contact(front, back), seen = contact({front, above}, {back, below});
  EXPECT_GT(unknown.overlap, 0.9);
  EXPECT_LT(seen.overlap, 0.1) << "but for what was seen at a grazing angle";
  const SurfaceContact half_known = contact({front, above}, back), same_side = contact({front, above}, {back, above});
  EXPECT_EQ(half_known.share, unknown.share);
  EXPECT_EQ(same_side.share, unknown.share);
}

TEST(SurfaceContact, TheOtherSideOfAWallIsNotMetWhicheverOfSeveralScansSawIt) {
  Scene scene(8);
  Points front = scene.sample(), both = scene.sample();
  for (Eigen::Vector3d& point : both) point.z() -= 0.8 * voxel_size;
  const std::size_t back = both.size();
  for (const Eigen::Vector3d& point : scene.sample()) both.emplace_back(point + Eigen::Vector3d(20, 0, 0));
  const Eigen::Vector3d above(0, 0, 100), below(0, 0, -100);
  const auto fused = [&](const std::optional<Eigen::Vector3d>& first) {
    Scan scan(both);
    scan.parts = {{back, first}, {both.size() - back, above}};
    return scan;
  };
  EXPECT_GT(contact({front, above}, fused({})).overlap, 0.9);
  EXPECT_GT(contact({front, above}, fused(above)).overlap, 0.9);
  EXPECT_LT(contact({front, above}, fused(below)).overlap, 0.1);
}

TEST(SurfaceContact, OfCloudsThatDoNotMeetSaysNothing) {
  Scene scene(5);
  const Points a = scene.sample(), b = scene.sample();
  const SurfaceContact c = contact(a, b, Transformation(Eigen::Translation3d(100, 0, 0)));
  EXPECT_EQ(c.share, 0.5);
  EXPECT_EQ(c.overlap, 0);
}

TEST(SurfaceContact, DoesNotDependOnTheFrame) {
  Scene scene(6);
  const Points a = scene.sample(), b = scene.sample();
  const SurfaceContact here = contact(a, b);
  const Transformation g = scene.random.motion(10), h = scene.random.motion(10);
  const SurfaceContact there = contact(testing::moved(g, a), testing::moved(h, b), h * g.inverse());
  EXPECT_NEAR(there.share, here.share, 0.02);  // other voxels
  EXPECT_NEAR(there.overlap, here.overlap, 0.02);
}

}  // namespace
}  // namespace igsp
