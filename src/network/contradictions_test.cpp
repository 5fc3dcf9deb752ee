#include "network/contradictions.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "igsp/simulation.hpp"

namespace igsp {
namespace {

NetworkLink link(std::size_t source, std::size_t target, double confidence, std::size_t triangles,
                 LinkState state = LinkState::used) {
  NetworkLink link;
  link.source = source;
  link.target = target;
  link.state = state;
  link.confidence = confidence;
  link.consistent_triangles = triangles;
  return link;
}

// Two groups of three scans, each in a loop, and a link from 3 to 2.
Network two_groups(double joining) {
  Network network;
  network.scans.resize(6);
  for (const std::size_t first : {0, 3}) {
    network.links.push_back(link(first + 1, first, 0.99, 1));
    network.links.push_back(link(first + 2, first, 0.99, 1));
    network.links.push_back(link(first + 2, first + 1, 0.99, 1));
  }
  network.links.push_back(link(3, 2, joining, 0, LinkState::unconfirmed));
  network.links.push_back(link(5, 0, 0.9, 0, LinkState::not_registered));
  return network;
}

TEST(Contradictions, LeaveOutTheLinksBetweenTheGroupsThatContradictEachOther) {
  const std::vector<NetworkContradiction> between = {{{1, 4}, 0.08}, {{0, 5}, 0.06}};
  EXPECT_EQ(contradicted_links(two_groups(0.6), between), std::vector<std::size_t>{6});
  // Two pairs of 1.4 and 1 decades outweigh log odds of 5, the most that counts, and one of 0.6 does not.
  EXPECT_EQ(contradicted_links(two_groups(0.9999), between), std::vector<std::size_t>{6});
  EXPECT_TRUE(contradicted_links(two_groups(0.9999), {{{1, 4}, 0.04}}).empty());
  EXPECT_TRUE(contradicted_links(two_groups(0.6), {}).empty());
}

TEST(Contradictions, OfLeavesAreNoneBelowOnePercentAndLittleAbove) {
  EXPECT_TRUE(contradicted_links(two_groups(0.9), {{{1, 4}, 0.012}, {{0, 5}, 0.012}}).empty());
}

TEST(Contradictions, DoNotOutweighLoopsByAPersonOrTwo) {
  EXPECT_TRUE(contradicted_links(two_groups(0.6), {{{0, 1}, 0.05}}).empty());
  // What lies within a group says nothing of the link between the groups.
  EXPECT_TRUE(contradicted_links(two_groups(0.6), {{{0, 2}, 0.05}, {{3, 4}, 0.03}}).empty());
  // The sixth scan by its two links, each as strong as both of its loop.
  const std::vector<NetworkContradiction> many = {
      {{0, 5}, 0.3}, {{1, 5}, 0.3}, {{2, 5}, 0.3}, {{3, 5}, 0.3}, {{4, 5}, 0.3}};
  Network network = two_groups(0.9999);
  EXPECT_EQ(contradicted_links(network, many), std::vector<std::size_t>{6});
  network.links.erase(network.links.begin() + 6);
  EXPECT_TRUE(contradicted_links(network, {{{3, 5}, 0.3}, {{4, 5}, 0.3}}).empty());
}

TEST(Contradictions, AreFoundWhereTheNetworkPutsTheScans) {
  const auto site = simulate("indoor", {.stations = 2, .points = 20000, .station_distance = 1.5, .seed = 5});
  Options options;
  options.scale.voxel_size = 0.1;
  std::vector<Features> features;
  std::vector<ScanShape> shapes;
  for (const SimulatedScan& scan : site) {
    features.push_back(extract_features(scan, options));
    shapes.push_back(shape_of(features.back()));
  }
  Network network;
  network.scans.resize(2);
  network.components = {{0, 1}};
  for (std::size_t i = 0; i < 2; ++i) network.scans[i].world_from_scan = site[i].world_from_scanner;
  const auto found = [&] {
    FeatureShelf shelf(
        2, [&](std::size_t i) { return features[i]; }, 0);
    SeenSpace space(shelf);
    return contradictions_at(network, shapes, space);
  };
  EXPECT_TRUE(found().empty());
  network.scans[1].world_from_scan.rotate(Eigen::AngleAxisd(std::numbers::pi / 4, Eigen::Vector3d::UnitZ()));
  ASSERT_EQ(found().size(), 1u);
  EXPECT_EQ(found()[0].scans, (std::array<std::size_t, 2>{0, 1}));
  EXPECT_GT(found()[0].violation, 0.05);
  network.components = {{0}, {1}};
  EXPECT_TRUE(found().empty());
  network.components = {{0, 1}};
  for (Features& scan : features) scan.viewpoint.reset();
  EXPECT_TRUE(found().empty());
}

}  // namespace
}  // namespace igsp
