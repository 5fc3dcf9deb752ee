#include "registration/hypotheses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using testing::Random;

constexpr double voxel_size = 0.1;

struct Scene {
  Points source, target;
  std::vector<Candidate> candidates;
  Options options;

  ConsistencyGraph graph() const {
    return consistency_graph(candidates, source, target, {2 * voxel_size, 4 * voxel_size, 0.785}, 1);
  }
  std::vector<Hypothesis> propose() const {
    return propose_hypotheses(candidates, graph(), source, target, voxel_size, options);
  }
};

/// `per_motion` candidates that follow each motion within half a voxel, and `wrong` that follow none.
Scene scene_of(Random& random, std::span<const Transformation> motions, std::size_t per_motion, std::size_t wrong) {
  Scene scene;
  const auto add = [&](const Eigen::Vector3d& source, const Eigen::Vector3d& target, const Eigen::Matrix3d& rotation) {
    const auto index = static_cast<std::uint32_t>(scene.source.size());
    scene.source.push_back(source);
    scene.target.push_back(target);
    scene.candidates.push_back({index, index, 1.0f, Eigen::Quaternionf(Eigen::Quaterniond(rotation))});
  };
  for (const Transformation& motion : motions) {
    for (std::size_t i = 0; i < per_motion; ++i) {
      const Eigen::Vector3d p = random.in_cube(3);
      const Eigen::AngleAxisd frame_error(random.uniform(-0.2, 0.2), random.direction());
      add(p, motion * p + random.in_cube(0.3 * voxel_size), frame_error * motion.linear());
    }
  }
  for (std::size_t i = 0; i < wrong; ++i) {
    const Eigen::Vector3d p = random.in_cube(3), q = random.in_cube(3);
    add(p, q, random.rotation());
  }
  return scene;
}

const Eigen::Vector3d centre = Eigen::Vector3d::Zero();

bool contains(const std::vector<Hypothesis>& hypotheses, const Transformation& truth) {
  return std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& h) {
    return (h.target_from_source.linear() - truth.linear()).norm() < 0.02 &&
           (h.target_from_source * centre - truth * centre).norm() < voxel_size;
  });
}

TEST(Hypotheses, FindTheMotionAmongNineTenthsOfWrongCandidates) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Random random(seed);
    const std::array truth{random.motion(5)};
    const auto hypotheses = scene_of(random, truth, 30, 270).propose();
    ASSERT_FALSE(hypotheses.empty());
    EXPECT_TRUE(contains({hypotheses.front()}, truth[0])) << "seed " << seed;
    EXPECT_GE(hypotheses.front().inliers, 30u);
  }
}

TEST(Hypotheses, OfferEveryMotionThatManyCandidatesFollow) {
  Random random(6);
  const std::array motions{random.motion(5), random.motion(5), random.motion(5)};
  const auto hypotheses = scene_of(random, motions, 25, 50).propose();
  for (const Transformation& motion : motions) EXPECT_TRUE(contains(hypotheses, motion));
}

TEST(Hypotheses, AreRigidAndCountTheirInliers) {
  Random random(7);
  const std::array motions{random.motion(5), random.motion(5)};
  const Scene scene = scene_of(random, motions, 25, 100);
  const auto hypotheses = scene.propose();
  ASSERT_FALSE(hypotheses.empty());
  for (const Hypothesis& h : hypotheses) {
    const Eigen::Matrix3d rotation = h.target_from_source.linear();
    EXPECT_LT((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(rotation.determinant(), 1, 1e-12);
    std::size_t inliers = 0;
    for (const Candidate& c : scene.candidates) {
      inliers += (scene.target[c.target] - h.target_from_source * scene.source[c.source]).norm() < 2.5 * voxel_size;
    }
    EXPECT_EQ(h.inliers, inliers);
  }
}

TEST(Hypotheses, KeepToTheirNumber) {
  Random random(8);
  std::vector<Transformation> motions;
  for (int i = 0; i < 6; ++i) motions.push_back(random.motion(5));
  Scene scene = scene_of(random, motions, 15, 0);
  EXPECT_GE(scene.propose().size(), 6u);
  scene.options.hypotheses.max_proposed = 2;
  EXPECT_EQ(scene.propose().size(), 2u);
}

TEST(Hypotheses, OfLevelledScansAreLevel) {
  Random random(9);
  Transformation truth(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));
  truth.translation() = Eigen::Vector3d(1, 2, 3);
  Scene scene = scene_of(random, std::array{truth}, 30, 100);
  scene.options.degrees_of_freedom = 4;
  const auto hypotheses = scene.propose();
  EXPECT_TRUE(contains(hypotheses, truth));
  for (const Hypothesis& h : hypotheses) EXPECT_EQ(h.target_from_source.linear().col(2), Eigen::Vector3d::UnitZ());
}

TEST(Hypotheses, OfNoCandidatesAreNone) {
  EXPECT_TRUE(Scene{}.propose().empty());
}

TEST(SamePose, AllowsFiveDegreesAndFourVoxels) {
  const auto moved_by = [](double degrees, double voxels) {
    Transformation t(Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d::UnitX()));
    t.translation() = Eigen::Vector3d(0, voxels * voxel_size, 0);
    return t;
  };
  const Transformation identity = Transformation::Identity();
  EXPECT_TRUE(same_pose(identity, identity, centre, voxel_size));
  EXPECT_TRUE(same_pose(identity, moved_by(4.9, 3.9), centre, voxel_size));
  EXPECT_FALSE(same_pose(identity, moved_by(5.1, 0), centre, voxel_size));
  EXPECT_FALSE(same_pose(identity, moved_by(0, 4.1), centre, voxel_size));
  // The distance is taken at the centre given: 4 degrees are 7 voxels at 100 voxels away.
  EXPECT_FALSE(same_pose(identity, moved_by(4, 0), Eigen::Vector3d(0, 100 * voxel_size, 0), voxel_size));
}

}  // namespace
}  // namespace igsp
