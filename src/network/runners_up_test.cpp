#include "network/runners_up.hpp"

#include <gtest/gtest.h>

#include "igsp/evaluation.hpp"
#include "igsp/simulation.hpp"

namespace igsp {
namespace {

// Three stations in their true frame, and a pair of the last two whose best pose is elsewhere.
struct Site {
  std::vector<SimulatedScan> scans =
      simulate("park", {.stations = 3, .points = 20000, .station_distance = 8, .seed = 3});
  std::vector<Features> features;
  std::vector<ScanShape> shapes;
  NetworkOptions options;
  Network network;
  Transformation truth = scans[1].world_from_scanner.inverse() * scans[2].world_from_scanner;

  Site() {
    options.pair.scale.voxel_size = network.voxel_size = 0.4;
    network.scans.resize(3);
    network.components = {{0, 1, 2}};
    for (std::size_t i = 0; i < 3; ++i) {
      features.push_back(extract_features(scans[i], options.pair));
      shapes.push_back(shape_of(features[i]));
      network.scans[i].world_from_scan = scans[i].world_from_scanner;
    }
    NetworkLink link;
    link.source = 2;
    link.target = 1;
    link.state = LinkState::rejected;
    link.confidence = 0.7;
    link.target_from_source.translation().x() = 20;
    link.runner_up = RunnerUp{truth, 0.8};
    link.runner_up->target_from_source.translation().x() += 0.5;
    network.links = {link};
  }
  std::vector<NetworkLink> found() {
    FeatureShelf shelf(
        3, [&](std::size_t i) { return features[i]; }, 0);
    return runners_up(network, shelf, shapes, options);
  }
  void part() {
    network.components = {{0, 1}, {2}};
    network.scans[2].component = 1;
  }
};

TEST(RunnersUp, TheNetworksOwnPoseIsRefinedAndUsed) {
  Site site;
  const std::vector<NetworkLink> found = site.found();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].origin, LinkOrigin::runner_up);
  EXPECT_EQ(found[0].state, LinkState::unconfirmed);
  EXPECT_LE(found[0].confidence, 0.3 + 1e-9) << "what the best pose leaves it";
  EXPECT_LT(pose_error(found[0].target_from_source, site.truth, {0, 0, 0}).translation, 0.1);
}

TEST(RunnersUp, AnotherPoseThanTheNetworksIsNot) {
  Site site;
  site.network.links[0].runner_up->target_from_source.translation().x() += 3;
  EXPECT_TRUE(site.found().empty());
  site = Site();
  site.network.links[0].state = LinkState::used;
  EXPECT_TRUE(site.found().empty());
  site.network.links[0].state = LinkState::rejected;
  site.network.links[0].runner_up.reset();
  EXPECT_TRUE(site.found().empty());
}

// It may join what no pair does, but not by itself: as a pair that was refused.
TEST(RunnersUp, BetweenFramesAreAPairThatNeedsWitnesses) {
  Site site;
  site.part();
  ASSERT_EQ(site.found().size(), 1u);
  EXPECT_EQ(site.found()[0].state, LinkState::not_registered);
  site.features[1].viewpoint.reset();
  EXPECT_TRUE(site.found().empty()) << "nobody could bear witness";
  site.features[1].viewpoint = Eigen::Vector3d::Zero();
  site.network.links[0].runner_up->share = 0.4;
  EXPECT_TRUE(site.found().empty()) << "the best pose explains far more";
}

}  // namespace
}  // namespace igsp
