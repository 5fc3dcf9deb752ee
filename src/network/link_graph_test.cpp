#include "network/link_graph.hpp"

#include <gtest/gtest.h>

#include "network/components.hpp"
#include "network/cycles.hpp"
#include "network/network_testing.hpp"

namespace igsp {
namespace {

using namespace network_testing;

std::vector<Transformation> random_poses(std::size_t count, std::uint64_t seed) {
  Dice dice(seed);
  std::vector<Transformation> poses;
  for (std::size_t i = 0; i < count; ++i) poses.push_back(dice.pose(100));
  return poses;
}

TEST(SmallMotion, StepAndMotionAreInverse) {
  Dice dice(1);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d centre = dice.step(1, 30).tail<3>();
    const Vector6 step = dice.step(1.7, 30);
    EXPECT_LT((step_about(centre, motion_about(centre, step)) - step).norm(), 1e-12);
  }
  EXPECT_EQ(step_about({1, 2, 3}, Transformation::Identity()).norm(), 0);
}

TEST(SmallMotion, TransportedStepIsTheSameMotion) {
  Dice dice(2);
  for (int i = 0; i < 50; ++i) {
    const Transformation b_from_a = dice.pose(50);
    const Eigen::Vector3d centre_a = dice.step(1, 30).tail<3>(), centre_b = dice.step(1, 30).tail<3>();
    const Vector6 step = dice.step(1e-5, 1e-5);
    const Transformation motion = b_from_a * motion_about(centre_a, step) * b_from_a.inverse();
    EXPECT_LT((step_about(centre_b, motion) - transport(b_from_a, centre_a, centre_b) * step).norm(), 1e-8);
  }
}

TEST(SmallMotion, LeftJacobianInverseIsTheDerivative) {
  Dice dice(3);
  for (int i = 0; i < 50; ++i) {
    const Vector6 large = dice.step(1.5, 0), small = dice.step(1e-6, 0);
    const Transformation both =
        motion_about(Eigen::Vector3d::Zero(), small) * motion_about(Eigen::Vector3d::Zero(), large);
    const Eigen::Vector3d change = step_about(Eigen::Vector3d::Zero(), both).head<3>() - large.head<3>();
    EXPECT_LT((change - left_jacobian_inverse(large.head<3>()) * small.head<3>()).norm(), 1e-10);
  }
}

TEST(LoopError, IsNothingForTrueLinksInEitherDirection) {
  const auto truth = random_poses(4, 5);
  LinkGraph graph{std::vector<Eigen::Vector3d>(4, {3, 2, 1}), {}};
  graph.links = {link_between(truth, 0, 1), link_between(truth, 2, 1), link_between(truth, 2, 3),
                 link_between(truth, 0, 3)};
  const LinkStep loop[] = {{0, true}, {1, false}, {2, true}, {3, false}};
  EXPECT_LT(loop_error(graph, loop), 1e-18);
}

TEST(LoopError, CountsSigmasOfTheWholeLoop) {
  const std::vector<Transformation> truth(3, Transformation::Identity());
  LinkGraph graph{std::vector<Eigen::Vector3d>(3, Eigen::Vector3d::Zero()), {}};
  Vector6 off = Vector6::Zero();
  off[4] = 3;  // six sigma of one link
  graph.links = {link_between(truth, 0, 1, off), link_between(truth, 1, 2), link_between(truth, 2, 0)};
  const LinkStep loop[] = {{0, true}, {1, true}, {2, true}};
  EXPECT_NEAR(loop_error(graph, loop), 36.0 / 3, 1e-9);
}

TEST(CycleSupport, TellsTrianglesThatCloseFromThoseThatDoNot) {
  const auto truth = random_poses(4, 6);
  LinkGraph graph{std::vector<Eigen::Vector3d>(4, Eigen::Vector3d::Zero()), {}};
  Vector6 wrong = Vector6::Zero();
  wrong[5] = 40;
  graph.links = {link_between(truth, 0, 1), link_between(truth, 1, 2), link_between(truth, 2, 0),
                 link_between(truth, 3, 1), link_between(truth, 3, 2, wrong)};
  graph.links[1].weight = 1;
  const auto support = cycle_support(graph, triangles(graph));
  EXPECT_EQ(support[0].triangles, 1u);
  EXPECT_EQ(support[0].open, 0u);
  EXPECT_EQ(support[0].support, 1);  // the weaker of the other two
  EXPECT_EQ(support[1].support, 3);
  EXPECT_EQ(support[1].open, 1u);
  EXPECT_EQ(support[4].triangles, 0u);
  EXPECT_EQ(support[4].open, 1u);
}

TEST(CycleSupport, CountsLessWhereATriangleJustCloses) {
  const std::vector<Transformation> truth(3, Transformation::Identity());
  LinkGraph graph{std::vector<Eigen::Vector3d>(3, Eigen::Vector3d::Zero()), {}};
  Vector6 off = Vector6::Zero();
  off[4] = 2;
  graph.links = {link_between(truth, 0, 1, off), link_between(truth, 1, 2), link_between(truth, 2, 0)};
  const auto support = cycle_support(graph, triangles(graph));
  EXPECT_EQ(support[0].triangles, 1u);
  EXPECT_LT(support[0].support, 0.5 * graph.links[1].weight);
  EXPECT_GT(support[0].support, 0);
}

TEST(Components, LargestFirstAndBridgesAreTheEdgesInNoLoop) {
  const std::vector<Edge> edges = {{4, 5}, {5, 6}, {6, 4}, {6, 7}, {1, 2}};
  const auto components = connected_components(8, edges);
  ASSERT_EQ(components.size(), 4u);
  EXPECT_EQ(components[0], (std::vector<std::size_t>{4, 5, 6, 7}));
  EXPECT_EQ(components[1], (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(components[2], (std::vector<std::size_t>{0}));
  EXPECT_EQ(bridges(8, edges), (std::vector<bool>{false, false, false, true, true}));
}

TEST(Components, ParallelEdgesAreALoop) {
  const std::vector<Edge> edges = {{0, 1}, {1, 0}, {1, 2}};
  EXPECT_EQ(bridges(3, edges), (std::vector<bool>{false, false, true}));
}

}  // namespace
}  // namespace igsp
