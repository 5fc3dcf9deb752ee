#include "network/feature_shelf.hpp"

#include <gtest/gtest.h>

#include "igsp/errors.hpp"
#include "igsp/simulation.hpp"

namespace igsp {
namespace {

Features numbered(std::size_t scan) {
  Features features;
  features.cloud_points = scan;
  return features;
}

TEST(FeatureShelf, HoldsThoseThatWereAskedForLast) {
  std::vector<std::size_t> asked;
  FeatureShelf shelf(
      4,
      [&](std::size_t scan) {
        asked.push_back(scan);
        return numbered(scan);
      },
      2);
  const std::weak_ptr<const Features> first = shelf.get(0);
  shelf.get(1);
  EXPECT_EQ(shelf.get(0)->cloud_points, 0u);  // now the first is the later one of both
  EXPECT_EQ(asked, (std::vector<std::size_t>{0, 1}));
  shelf.get(2);
  EXPECT_FALSE(first.expired());
  EXPECT_EQ(shelf.get(1)->cloud_points, 1u);
  EXPECT_TRUE(first.expired());
  EXPECT_EQ(asked, (std::vector<std::size_t>{0, 1, 2, 1}));
  const std::shared_ptr<const Features> kept = shelf.get(3);
  shelf.get(0);
  shelf.get(1);
  EXPECT_EQ(kept->cloud_points, 3u);
}

TEST(FeatureShelf, AsksOnceWhereAllAreHeld) {
  int asked = 0;
  FeatureShelf shelf(
      3, [&](std::size_t scan) { return ++asked, numbered(scan); }, 0);
  for (int turn = 0; turn < 2; ++turn) {
    for (std::size_t scan = 0; scan < 3; ++scan) EXPECT_EQ(shelf.get(scan)->cloud_points, scan);
  }
  EXPECT_EQ(asked, 3);
}

// Whatever is held: the same bits, more questions.
TEST(FeatureShelf, ANetworkDoesNotDependOnIt) {
  const std::vector<SimulatedScan> scans =
      simulate("park", {.stations = 4, .points = 20000, .station_distance = 8, .seed = 3});
  NetworkOptions options;
  options.pair.scale.voxel_size = 0.6;
  std::vector<Features> features;
  for (const SimulatedScan& scan : scans) features.push_back(extract_features(scan, options.pair));
  for (const PairRule rule : {PairRule::all, PairRule::automatic}) {
    options.pairs = rule;
    options.features_in_memory = 0;
    const Network all = register_network(features, options);
    ASSERT_EQ(all.components.front().size(), 4u);
    options.features_in_memory = 1;
    std::size_t asked = 0;
    const Network few = register_network(
        4, [&](std::size_t scan) { return ++asked, features[scan]; }, options);
    EXPECT_GT(asked, 8u);
    ASSERT_EQ(few.links.size(), all.links.size());
    EXPECT_EQ(few.bundle_error, all.bundle_error);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(few.scans[i].world_from_scan.matrix(), all.scans[i].world_from_scan.matrix());
      EXPECT_EQ(few.scans[i].covariance, all.scans[i].covariance);
    }
  }
}

TEST(FeatureShelf, ASourceThatFailsTheSecondTimeEndsTheRun) {
  const std::vector<SimulatedScan> scans = simulate("park", {.stations = 2, .points = 5000, .seed = 3});
  NetworkOptions options;
  options.pair.scale.voxel_size = 1;
  options.features_in_memory = 1;
  int asked = 0;
  const auto source = [&](std::size_t scan) {
    if (++asked > 2) throw FileError("gone");
    return extract_features(scans[scan], options.pair);
  };
  EXPECT_THROW(register_network(2, source, options), FileError);
}

}  // namespace
}  // namespace igsp
