#include "registration/common_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "estimation/robust_fit.hpp"
#include "features/bsc.hpp"
#include "registration/frame_testing.hpp"

namespace igsp {
namespace {

using testing::Random;
using testing::Scene;

int distance(const Descriptor& a, const Descriptor& b) {
  int count = 0;
  for (int word = 0; word < bsc_words; ++word) count += std::popcount(a[word] ^ b[word]);
  return count;
}

TEST(CommonFrame, DescribesBothCloudsAlongTheTargetsAxes) {
  const Scene scene(1);
  CommonFrame frame = scene.frame();
  const auto& target = frame.target_descriptors();
  const auto& source = frame.source_descriptors(scene.truth.linear());
  ASSERT_EQ(target.size(), scene.target.keypoints.size());
  ASSERT_EQ(source.size(), scene.source.keypoints.size());
  const double radius = frame.descriptor_radius();
  Support support;
  for (std::size_t i = 0; i < source.size(); ++i) {
    gather_support(scene.prepared_source.grid, scene.prepared_source.keypoints[i], radius, support);
    EXPECT_EQ(source[i], binary_shape_context(support, scene.truth.linear().transpose(), radius));
  }
  gather_support(scene.prepared_target.grid, scene.prepared_target.keypoints[0], radius, support);
  EXPECT_EQ(target[0], binary_shape_context(support, Eigen::Matrix3d::Identity(), radius));
}

TEST(CommonFrame, ReusesDescriptorsWithinTwoDegrees) {
  const Scene scene(2);
  CommonFrame frame = scene.frame();
  const auto turned = [&](double degrees) {
    const Eigen::AngleAxisd turn(degrees * M_PI / 180, Eigen::Vector3d(1, 2, 3).normalized());
    return Eigen::Matrix3d(turn * scene.truth.linear());
  };
  const std::vector<Descriptor> first = frame.source_descriptors(turned(0));
  EXPECT_EQ(frame.source_descriptors(turned(1.9)), first);
  EXPECT_NE(frame.source_descriptors(turned(2.1)), first);
  EXPECT_EQ(frame.source_descriptors(turned(-5.9), Look::whole, 6 * M_PI / 180), first) << "where that angle will do";
  EXPECT_NE(frame.source_descriptors(turned(-5.9)), first);
  EXPECT_NE(frame.source_descriptors(turned(-4.5), Look::whole, 6 * M_PI / 180), first) << "the nearest one";
}

TEST(CommonFrame, AFirstLookIsPartOfTheWholeOne) {
  const Scene scene(2);
  CommonFrame at_once = scene.frame(), frame = scene.frame();
  const Eigen::Matrix3d rotation = scene.truth.linear();
  const std::vector<Descriptor> whole = at_once.source_descriptors(rotation);
  const std::vector<Descriptor> some = frame.source_descriptors(rotation, Look::first);
  const std::size_t step = frame.first_look_step();
  ASSERT_GT(step, 1u);
  EXPECT_GE(whole.size() / step, 45u);
  EXPECT_LE(whole.size() / step, 90u);
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(some[i], i % step == 0 ? whole[i] : Descriptor{}) << i;
  EXPECT_EQ(frame.source_descriptors(rotation), whole);
  EXPECT_EQ(frame.source_descriptors(rotation, Look::first), whole) << "what is known stays";
}

TEST(CommonFrame, FewKeypointsAreAllLookedAtFirst) {
  const Scene scene(2, {.half_side = 1.5});
  CommonFrame frame = scene.frame(), other = scene.frame();
  ASSERT_LT(scene.source.keypoints.size(), 90u);
  EXPECT_EQ(frame.first_look_step(), 1u);
  EXPECT_EQ(frame.source_descriptors(scene.truth.linear(), Look::first),
            other.source_descriptors(scene.truth.linear()));
  EXPECT_EQ(frame.source_descriptors(scene.truth.linear()), other.source_descriptors(scene.truth.linear()));
}

TEST(MutualMatches, AreNearestToEachOther) {
  const Scene scene(3);
  CommonFrame frame = scene.frame();
  const auto source = frame.source_descriptors(scene.truth.linear());
  const auto& target = frame.target_descriptors();
  const auto nearest = [](const Descriptor& one, const std::vector<Descriptor>& all) {
    return std::min_element(all.begin(), all.end(),
                            [&](const auto& a, const auto& b) { return distance(one, a) < distance(one, b); }) -
           all.begin();
  };
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> expected;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const auto j = nearest(source[i], target);
    if (nearest(target[j], source) != static_cast<std::ptrdiff_t>(i)) continue;
    expected.emplace_back(scene.prepared_source.keypoints[i], scene.prepared_target.keypoints[j]);
  }
  const auto matches = mutual_matches(frame, scene.truth.linear(), 1);
  ASSERT_EQ(matches.size(), expected.size());
  ASSERT_GT(matches.size(), 20u);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    EXPECT_EQ(matches[k].source, expected[k].first);
    EXPECT_EQ(matches[k].target, expected[k].second);
    EXPECT_EQ(matches[k].weight, 1);
  }
  for (const int threads : {2, 4}) {
    CommonFrame other = scene.frame(threads);
    EXPECT_EQ(mutual_matches(other, scene.truth.linear(), threads).size(), matches.size());
  }
}

TEST(MutualMatches, OfAFirstLookAreThoseOfEveryFewKeypoints) {
  const Scene scene(3);
  CommonFrame frame = scene.frame();
  const auto matches = mutual_matches(frame, scene.truth.linear(), 1, Look::first);
  const std::size_t step = frame.first_look_step();
  ASSERT_GT(matches.size(), 10u);
  EXPECT_GT(count_inliers(matches, scene.truth, 0.25), matches.size() / 2);
  for (const PointPair& match : matches) {
    const auto& keypoints = scene.prepared_source.keypoints;
    const auto place = std::ranges::find(keypoints, match.source);
    ASSERT_NE(place, keypoints.end());
    EXPECT_EQ(static_cast<std::size_t>(place - keypoints.begin()) % step, 0u);
  }
}

TEST(Rematch, FindsThePoseFromARotationThatIsNearlyRight) {
  for (std::uint64_t seed = 4; seed < 7; ++seed) {
    const Scene scene(seed);
    CommonFrame frame = scene.frame();
    Transformation hypothesis = scene.truth;
    hypothesis.linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 1, 0).normalized()) * scene.truth.linear();
    hypothesis.translation() += Eigen::Vector3d(1, -2, 1);  // 24 voxels away
    const Rematch found = rematch(frame, hypothesis, 6, 1);
    EXPECT_LT((found.target_from_source.linear() - scene.truth.linear()).norm(), 0.05) << "seed " << seed;
    EXPECT_LT((found.target_from_source.translation() - scene.truth.translation()).norm(), 0.1) << "seed " << seed;
    std::size_t agreeing = 0;
    for (const PointPair& match : found.matches) {
      agreeing += (match.target - found.target_from_source * match.source).norm() < 0.25;
    }
    EXPECT_EQ(found.agreeing, agreeing);
  }
}

TEST(Rematch, OfNoKeypointsKeepsTheHypothesis) {
  Features nothing;
  nothing.voxel_size = 0.1;
  const PreparedCloud prepared(nothing);
  CommonFrame frame(prepared, prepared, 0.7, 1);
  Random random(8);
  const Transformation hypothesis = random.motion(1);
  const Rematch found = rematch(frame, hypothesis, 6, 1);
  EXPECT_EQ(found.target_from_source.matrix(), hypothesis.matrix());
  EXPECT_TRUE(found.matches.empty());
  EXPECT_EQ(found.agreeing, 0u);
}

TEST(FitInPlace, StaysWhereTheVoteWouldGoToAnotherRoom) {
  const testing::Scene scene(2);
  const CommonFrame frame = scene.frame();
  testing::Random random(8);
  std::vector<PointPair> matches;
  const Eigen::Vector3d next_room(5, 0, 0);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d place = random.in_cube(3), error = 0.02 * random.in_cube(1);
    matches.push_back({place, place + error + (i < 10 ? Eigen::Vector3d::Zero() : next_room)});
  }
  Transformation near = Transformation::Identity();
  near.translation() = Eigen::Vector3d(0.25, -0.2, 0.1);
  const Rematch found = fit_in_place(frame, near, matches, 6);
  EXPECT_EQ(found.agreeing, 10u);
  EXPECT_LT(found.target_from_source.translation().norm(), 0.03);
  EXPECT_EQ(found.matches.size(), matches.size());
}

}  // namespace
}  // namespace igsp
