#include "network/pose_graph.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "network/components.hpp"
#include "network/network_testing.hpp"
#include "network/spanning_forest.hpp"

namespace igsp {
namespace {

using namespace network_testing;

// Stations on a circle of 200 voxels, each turned its own way.
std::vector<Transformation> ring_of_poses(std::size_t count, std::uint64_t seed) {
  Dice dice(seed);
  std::vector<Transformation> poses;
  for (std::size_t i = 0; i < count; ++i) {
    Transformation pose = dice.pose(5);
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    pose.translation() += Eigen::Vector3d(200 * std::cos(angle), 200 * std::sin(angle), 0);
    poses.push_back(pose);
  }
  return poses;
}

struct Outcome {
  std::vector<bool> kept;  // per link
  std::vector<std::vector<std::size_t>> components;
  double worst = 0;  // displacement of a centre against the truth, as seen from scan 0
};

Outcome solve(const LinkGraph& graph, const std::vector<Transformation>& truth) {
  const std::vector<std::size_t> forest = spanning_forest(graph, cycle_support(graph, triangles(graph))).links;
  std::vector<Edge> edges;
  for (const std::size_t l : forest) edges.emplace_back(graph.links[l].source, graph.links[l].target);
  Outcome outcome;
  outcome.components = connected_components(graph.centres.size(), edges);
  std::vector<std::size_t> anchors;
  for (const auto& scans : outcome.components) anchors.push_back(scans.front());
  const BalancedPoses poses = balance_poses(graph, forest, anchors);
  for (const double error : poses.errors) outcome.kept.push_back(error < max_loop_error);
  for (const std::size_t i : outcome.components.front()) {
    const std::size_t first = outcome.components.front().front();
    const Transformation difference =
        truth[first].inverse() * truth[i] * poses.world_from_scan[i].inverse() * poses.world_from_scan[first];
    outcome.worst = std::max(outcome.worst, difference.translation().norm());
  }
  return outcome;
}

LinkGraph empty_graph(std::size_t scans) {
  return {std::vector<Eigen::Vector3d>(scans, Eigen::Vector3d::Zero()), {}};
}

TEST(PoseGraph, ChainWithoutLoopsIsItsLinks) {
  const auto truth = ring_of_poses(6, 1);
  LinkGraph graph = empty_graph(6);
  for (std::size_t i = 1; i < 6; ++i) graph.links.push_back(link_between(truth, i, i - 1));
  const Outcome outcome = solve(graph, truth);
  EXPECT_EQ(outcome.components.size(), 1u);
  EXPECT_LT(outcome.worst, 1e-9);
}

TEST(PoseGraph, LinkWithoutALoopStandsAloneOnlyIfItMay) {
  const auto truth = ring_of_poses(3, 1);
  LinkGraph graph = empty_graph(3);
  graph.links = {link_between(truth, 1, 0), link_between(truth, 2, 1)};
  graph.links[1].may_stand_alone = false;
  EXPECT_EQ(solve(graph, truth).components.size(), 2u);
}

TEST(PoseGraph, SpreadsTheErrorOfARing) {
  const auto truth = ring_of_poses(12, 2);
  Dice dice(3);
  LinkGraph graph = empty_graph(12);
  for (std::size_t i = 0; i < 12; ++i) {
    graph.links.push_back(link_between(truth, (i + 1) % 12, i, dice.step(0.001, 0.3)));
  }
  LinkGraph chain = graph;
  chain.links.pop_back();
  const Outcome ring = solve(graph, truth);
  EXPECT_TRUE(std::ranges::all_of(ring.kept, [](bool kept) { return kept; }));
  EXPECT_LT(ring.worst, solve(chain, truth).worst);
}

TEST(PoseGraph, MinimumHasNoGradient) {
  const auto truth = ring_of_poses(8, 2);
  Dice dice(4);
  LinkGraph graph = empty_graph(8);
  for (std::size_t i = 0; i < 8; ++i) {
    graph.links.push_back(link_between(truth, (i + 1) % 8, i, dice.step(0.002, 0.1)));
    graph.links.push_back(link_between(truth, (i + 2) % 8, i, dice.step(0.002, 0.1)));
  }
  const auto forest = spanning_forest(graph, cycle_support(graph, triangles(graph))).links;
  const std::size_t anchor[] = {0};
  const BalancedPoses poses = balance_poses(graph, forest, anchor);
  // The loss itself, written down once more: Geman-McClure of information that equals the inverse tolerance.
  const auto loss = [&](const std::vector<Transformation>& world) {
    double sum = 0;
    for (const GraphLink& link : graph.links) {
      const Vector6 step = step_about(
          link.centre, world[link.target].inverse() * world[link.source] * link.target_from_source.inverse());
      const double squared = step.dot(link.information * step), scale = max_loop_error / 9;
      sum += scale * squared / (scale + squared);
    }
    return sum;
  };
  const double least = loss(poses.world_from_scan);
  for (std::size_t i = 1; i < 8; ++i) {
    for (int axis = 0; axis < 6; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        std::vector<Transformation> moved = poses.world_from_scan;
        Vector6 step = Vector6::Zero();
        step[axis] = sign * (axis < 3 ? 1e-4 : 1e-2);
        moved[i] = moved[i] * motion_about(graph.centres[i], step);
        EXPECT_GT(loss(moved), least);
      }
    }
  }
}

TEST(PoseGraph, RingOfNeighboursFindsItsWrongClosing) {
  const auto truth = ring_of_poses(10, 4);
  Dice dice(5);
  LinkGraph graph = empty_graph(10);
  for (std::size_t i = 0; i < 10; ++i) {
    const Vector6 error = i == 9 ? dice.step(1, 100) : dice.step(0.001, 0.1);
    graph.links.push_back(link_between(truth, (i + 1) % 10, i, error));
    graph.links.push_back(link_between(truth, (i + 2) % 10, i, dice.step(0.001, 0.1)));
  }
  const Outcome outcome = solve(graph, truth);
  for (std::size_t l = 0; l < graph.links.size(); ++l) EXPECT_EQ(outcome.kept[l], l != 18) << l;
  EXPECT_EQ(outcome.components.size(), 1u);
  EXPECT_LT(outcome.worst, 1);
}

TEST(PoseGraph, RingThatDoesNotCloseLosesItsWeakestLink) {
  const auto truth = ring_of_poses(6, 4);
  LinkGraph graph = empty_graph(6);
  for (std::size_t i = 0; i < 6; ++i) graph.links.push_back(link_between(truth, (i + 1) % 6, i));
  Vector6 wrong = Vector6::Zero();
  wrong[3] = 80;
  graph.links[5] = link_between(truth, 0, 5, wrong);
  graph.links[5].weight = 1;
  const Outcome outcome = solve(graph, truth);
  for (std::size_t l = 0; l < 6; ++l) EXPECT_EQ(outcome.kept[l], l != 5) << l;
  EXPECT_LT(outcome.worst, 1e-9);
}

TEST(PoseGraph, GroupsBetweenWhichLinksOnlyDisagreeAreNotGlued) {
  const auto truth = ring_of_poses(8, 5);
  Dice dice(6);
  LinkGraph graph = empty_graph(8);
  for (const std::size_t first : {std::size_t{0}, std::size_t{4}}) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        graph.links.push_back(link_between(truth, first + i, first + j, dice.step(0.001, 0.1)));
      }
    }
  }
  for (std::size_t i = 0; i < 4; ++i) graph.links.push_back(link_between(truth, 4 + i, i, dice.step(1, 100)));
  const Outcome outcome = solve(graph, truth);
  EXPECT_EQ(outcome.components.size(), 2u);
  for (std::size_t l = 12; l < 16; ++l) EXPECT_FALSE(outcome.kept[l]);
}

// Where an optimiser that starts cold rejects every link (docs/network.md).
TEST(PoseGraph, FindsFortyPoisonedLinksOf179) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Dice dice(seed);
    const auto truth = ring_of_poses(60, seed);
    LinkGraph graph = empty_graph(60);
    std::vector<bool> right;
    std::set<Edge> taken;
    const auto add = [&](std::size_t a, std::size_t b, bool is_right) {
      if (a == b || !taken.insert(std::minmax(a, b)).second) return;
      graph.links.push_back(link_between(truth, a, b, is_right ? dice.step(0.002, 0.2) : dice.step(1.5, 200)));
      right.push_back(is_right);
    };
    for (std::size_t i = 0; i < 60; ++i) add((i + 1) % 60, i, true);
    for (std::size_t i = 0; i < 60; ++i) add((i + 2) % 60, i, true);
    while (graph.links.size() < 139) {
      const std::size_t a = dice.below(60);
      add((a + 3 + dice.below(3)) % 60, a, true);
    }
    while (graph.links.size() < 179) add(dice.below(60), dice.below(60), false);
    const Outcome outcome = solve(graph, truth);
    EXPECT_EQ(outcome.kept, right) << "seed " << seed;
    EXPECT_EQ(outcome.components.size(), 1u);
    EXPECT_LT(outcome.worst, 3) << "seed " << seed;
  }
}

}  // namespace
}  // namespace igsp
