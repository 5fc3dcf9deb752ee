// The network as its users meet it: scans in, one frame out, and what does not belong stays out of it.
#include "igsp/network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "igsp/align.hpp"
#include "igsp/errors.hpp"
#include "igsp/evaluation.hpp"
#include "igsp/simulation.hpp"

namespace igsp {
namespace {

std::vector<SimulatedScan> park(std::uint64_t seed, int stations) {
  return simulate("park", {.stations = stations, .points = 30000, .station_distance = 8, .seed = seed});
}

NetworkOptions fast_options() {
  NetworkOptions options;
  options.pair.scale.target_points = 3000;
  return options;
}

std::vector<Scan> views(const std::vector<SimulatedScan>& scans) {
  return {scans.begin(), scans.end()};
}

// Of scans whose true poses share a world: rotation [rad] and displacement of the centre, seen from the component's
// first scan.
void expect_right(const Network& network, const std::vector<std::size_t>& component,
                  const std::vector<SimulatedScan>& scans, std::size_t first_of_site) {
  const auto truth = [&](std::size_t i) { return scans[i - first_of_site].world_from_scanner; };
  for (const std::size_t i : component) {
    const Transformation expected = truth(component.front()).inverse() * truth(i);
    const PoseError error = pose_error(network.scans[i].world_from_scan, expected, Eigen::Vector3d::Zero());
    EXPECT_LT(error.rotation_rad, 0.01) << i;
    EXPECT_LT(error.translation, 0.1) << i;
  }
}

TEST(Network, TwoSitesInOneFolderAreTwoComponents) {
  const auto site = park(3, 4), other = park(11, 3);
  std::vector<Scan> scans = views(site);
  for (const SimulatedScan& scan : other) scans.push_back(scan);
  const Network network = register_network(std::span<const Scan>(scans), fast_options());
  ASSERT_EQ(network.components.size(), 2u);
  EXPECT_EQ(network.components[0], (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(network.components[1], (std::vector<std::size_t>{4, 5, 6}));
  expect_right(network, network.components[0], site, 0);
  expect_right(network, network.components[1], other, 4);
  EXPECT_GT(network.bundle_error, 0);
  EXPECT_LT(network.bundle_error, 0.05);
}

TEST(Network, SameScanTwiceOneOfTenPointsAndAnEmptyOneDoNotDisturbTheRest) {
  const auto site = park(3, 3);
  const Points few(site[0].points.begin(), site[0].points.begin() + 10), none;
  const std::vector<Scan> scans = {site[0], few, site[1], none, site[0], site[2]};
  const Network network = register_network(std::span<const Scan>(scans), fast_options());
  EXPECT_EQ(network.components[0], (std::vector<std::size_t>{0, 2, 4, 5}));
  EXPECT_EQ(network.components.size(), 3u);
  EXPECT_EQ(network.scans[3].problem, "cloud has no points; at least one is needed");
  EXPECT_EQ(network.scans[1].problem, "");
  const PoseError twin = pose_error(network.scans[4].world_from_scan, Transformation::Identity(), {0, 0, 0});
  EXPECT_LT(twin.translation, 0.05);
  EXPECT_LT(twin.rotation_rad, 0.005);
}

// Nothing contradicts a refused pair on large voxels, and nothing contradicts like rooms there either.
TEST(Network, ARefusedPairJoinsScansOnlyWhereTheFreeSpaceOfFineVoxelsIsClear) {
  const auto site = park(3, 2);
  Options options = fast_options().pair;
  options.scale.voxel_size = 0.5;
  std::vector<Features> features;
  for (const Scan& scan : views(site)) features.push_back(extract_features(scan, options));
  for (const int rung_size : {1, 2, 4, 8}) {
    SCOPED_TRACE(rung_size);
    PairStore store;
    store.find = [&](std::size_t source, std::size_t target) {
      Result refused = align(features[source], features[target], options);
      refused.registered = false;
      refused.confidence = 0.3;
      refused.evidence.agreeing_matches = 40;
      refused.evidence.free_space = {FreeSpaceViolation{500, 0}, FreeSpaceViolation{500, 0}};
      refused.evidence.voxel_size = rung_size * refused.voxel_size;
      return std::optional(refused);
    };
    const Network network = register_network(
        features.size(), [&](std::size_t i) { return features[i]; }, fast_options(), {}, store);
    EXPECT_EQ(network.components.size(), rung_size <= 2 ? 1u : 2u);
  }
}

TEST(Network, TwoScansAreOneUnconfirmedLink) {
  const auto site = park(3, 2);
  const std::vector<Scan> scans = views(site);
  const Network network = register_network(std::span<const Scan>(scans), fast_options());
  ASSERT_EQ(network.links.size(), 1u);
  EXPECT_EQ(network.links[0].state, LinkState::unconfirmed);
  EXPECT_EQ(network.components.size(), 1u);
  EXPECT_LT(network.links[0].residual, 1e-3);  // nothing but the fine registration done once more
  EXPECT_GT(network.links[0].median_distance, 0);
  EXPECT_GT(network.links[0].rms_distance, network.links[0].median_distance);
  EXPECT_LT(network.links[0].rms_distance, network.voxel_size / 2);
  const auto& covariance = network.scans[1].covariance;
  EXPECT_GT(covariance.diagonal().minCoeff(), 0);
  EXPECT_EQ(network.scans[0].covariance.norm(), 0);
  // That of the pair, about another centre, which leaves the volume of the ellipsoid as it is.
  const double axes =
      std::pow(covariance.determinant() / network.links[0].precision.covariance.determinant(), 1.0 / 12);
  EXPECT_NEAR(std::log(axes), 0, std::log(1.4)) << "half axes " << axes << " times as long";
}

// Its truth is exact, so the errors are those of the registration alone.
TEST(Network, SpreadsErrorsSoThatScansLieBetterThanSinglePairsPutThem) {
  double of_pairs = 0, of_network = 0;
  std::size_t used = 0;
  for (const std::uint64_t seed : {1, 5, 9}) {
    SCOPED_TRACE(seed);
    const auto site = park(seed, 5);
    const std::vector<Scan> scans = views(site);
    const Network network = register_network(std::span<const Scan>(scans), fast_options());
    ASSERT_EQ(network.components.size(), 1u);
    const auto error = [&](const Transformation& target_from_source, std::size_t source, std::size_t target) {
      const Transformation truth = site[target].world_from_scanner.inverse() * site[source].world_from_scanner;
      return pose_error(target_from_source, truth, Eigen::Vector3d::Zero()).centroid_displacement;
    };
    for (const NetworkLink& link : network.links) {
      if (link.state != LinkState::used && link.state != LinkState::unconfirmed) continue;
      const Transformation by_network =
          network.scans[link.target].world_from_scan.inverse() * network.scans[link.source].world_from_scan;
      of_pairs += std::pow(error(link.target_from_source, link.source, link.target), 2);
      of_network += std::pow(error(by_network, link.source, link.target), 2);
      ++used;
    }
    for (const NetworkScan& scan : network.scans) {
      const double sigma = std::sqrt(scan.covariance.bottomRightCorner<3, 3>().trace());
      EXPECT_LT(sigma, 0.05);
    }
  }
  ASSERT_GE(used, 18u);
  EXPECT_LT(of_network, of_pairs);
  RecordProperty("pairs", std::to_string(std::sqrt(of_pairs / used)));
  RecordProperty("network", std::to_string(std::sqrt(of_network / used)));
}

TEST(Network, SameBitsForAnyNumberOfThreads) {
  const auto site = park(5, 4);
  const std::vector<Scan> scans = views(site);
  NetworkOptions options = fast_options();
  options.pair.threads = 1;
  const Network one = register_network(std::span<const Scan>(scans), options);
  options.pair.threads = 3;
  const Network three = register_network(std::span<const Scan>(scans), options);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(one.scans[i].world_from_scan.matrix(), three.scans[i].world_from_scan.matrix());
    EXPECT_EQ(one.scans[i].covariance, three.scans[i].covariance);
  }
}

// What the sixth station shares with each of the others is too little, in thin scans 20 m apart.
TEST(Network, AScanThatNoPairPlacesIsTriedAgainstMergedNeighbours) {
  const auto site = simulate("park", {.stations = 8, .points = 6000, .station_distance = 20, .seed = 2});
  NetworkOptions options;
  options.pair.scale.voxel_size = 0.94;
  const std::vector<Scan> scans = views(site);
  const Network network = register_network(std::span<const Scan>(scans), options);
  ASSERT_EQ(network.components.size(), 1u);
  const auto merged = std::ranges::find(network.links, LinkOrigin::merged, &NetworkLink::origin);
  ASSERT_NE(merged, network.links.end());
  EXPECT_EQ(merged->source, 5u);
  EXPECT_EQ(merged->state, LinkState::unconfirmed);
  EXPECT_EQ(merged->merged.size(), 7u);
  EXPECT_EQ(merged->merged[0], merged->target);
  EXPECT_GT(merged->median_distance, 0) << "the joint refinement takes it to all of them";
  EXPECT_LT(merged->median_distance, 0.1);
  const Transformation truth = site[0].world_from_scanner.inverse() * site[5].world_from_scanner;
  EXPECT_LT(pose_error(network.scans[5].world_from_scan, truth, {0, 0, 0}).translation, 0.3);
  options.pairs = PairRule::listed;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) options.listed_pairs.emplace_back(i, j);
  }
  const Network pairs_alone = register_network(std::span<const Scan>(scans), options);
  EXPECT_EQ(pairs_alone.components.size(), 2u);
  EXPECT_EQ(pairs_alone.components[1], std::vector<std::size_t>{5});
}

TEST(Network, LikelyPairsPlaceTheSameScansWithFewerTries) {
  const auto site = park(3, 10);
  const std::vector<Scan> scans = views(site);
  NetworkOptions options = fast_options();
  options.pairs = PairRule::automatic;
  const Network network = register_network(std::span<const Scan>(scans), options);
  ASSERT_EQ(network.components.size(), 1u);
  expect_right(network, network.components[0], site, 0);
  EXPECT_LT(network.links.size(), 45u);
  for (std::size_t i = 1; i < network.links.size(); ++i) {
    const NetworkLink &before = network.links[i - 1], &link = network.links[i];
    EXPECT_LT(ScanPair(before.source, before.target), ScanPair(link.source, link.target));
  }
}

TEST(Network, OnlyListedPairsAreTried) {
  const auto site = park(3, 3);
  const std::vector<Scan> scans = views(site);
  NetworkOptions options = fast_options();
  options.pairs = PairRule::listed;
  options.listed_pairs = {{2, 1}, {0, 2}, {1, 2}};
  const Network network = register_network(std::span<const Scan>(scans), options);
  ASSERT_EQ(network.links.size(), 2u);
  EXPECT_EQ(network.links[0].source, 2u);
  EXPECT_EQ(network.links[0].target, 0u);
  EXPECT_EQ(network.links[1].target, 1u);
  for (const ScanPair& wrong : {ScanPair{1, 1}, ScanPair{0, 3}}) {
    options.listed_pairs = {wrong};
    EXPECT_THROW(register_network(std::span<const Scan>(scans), options), InvalidArgument);
  }
}

TEST(Network, FixedScanIsTheWorld) {
  const auto site = park(3, 4);
  const std::vector<Scan> scans = views(site);
  NetworkOptions options = fast_options();
  const Network first = register_network(std::span<const Scan>(scans), options);
  options.fixed_scan = 2;
  const Network network = register_network(std::span<const Scan>(scans), options);
  EXPECT_EQ(network.scans[2].world_from_scan.matrix(), Transformation::Identity().matrix());
  EXPECT_EQ(network.scans[2].covariance.norm(), 0);
  EXPECT_GT(network.scans[0].covariance.norm(), 0);
  for (std::size_t i = 0; i < 4; ++i) {
    const Transformation expected = first.scans[2].world_from_scan.inverse() * first.scans[i].world_from_scan;
    EXPECT_LT((network.scans[i].world_from_scan.matrix() - expected.matrix()).norm(), 1e-3) << i;
  }
}

TEST(Network, ControlPutsAllScansIntoItsWorldAndSharesItsErrors) {
  const auto site = park(3, 4);
  const std::vector<Scan> scans = views(site);
  NetworkOptions options = fast_options();
  Transformation world = Transformation::Identity();
  world.linear() = Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  world.translation() = Eigen::Vector3d(4000, 5000, 100);
  for (const std::size_t i : {0, 1, 2}) {
    options.control.push_back({i, world * site[i].world_from_scanner.translation(), 0.01, {}, 0});
  }
  options.control.push_back(
      {3, world * (site[3].world_from_scanner.translation() + Eigen::Vector3d(0, 0, 5)), 50, {}, 0});
  const Network network = register_network(std::span<const Scan>(scans), options);
  EXPECT_TRUE(network.warnings.empty());
  for (std::size_t i = 0; i < 4; ++i) {
    const PoseError error =
        pose_error(network.scans[i].world_from_scan, world * site[i].world_from_scanner, Eigen::Vector3d::Zero());
    EXPECT_LT(error.rotation_rad, 0.01) << i;
    EXPECT_LT(error.centroid_displacement, 0.1) << i;
    EXPECT_GT(network.scans[i].covariance.diagonal().minCoeff(), 0);
    EXPECT_LT((network.scans[i].covariance.bottomRightCorner<3, 3>().trace()), 0.01);
  }
  EXPECT_LT(*network.scans[0].control_residual, 0.05);
  EXPECT_NEAR(*network.scans[3].control_residual, 5, 0.1);
}

TEST(Network, LevelledScansStayLevelled) {
  const auto site = park(3, 4);
  const std::vector<Scan> scans = views(site);
  NetworkOptions options = fast_options();
  options.pair.degrees_of_freedom = 4;
  const Network network = register_network(std::span<const Scan>(scans), options);
  ASSERT_EQ(network.components.size(), 1u);
  expect_right(network, network.components[0], site, 0);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(network.scans[i].world_from_scan.linear()(2, 2), 1.0);
    EXPECT_GT(network.scans[i].covariance(2, 2), 0);
    EXPECT_LT((network.scans[i].covariance.topLeftCorner<2, 2>().norm()), 1e-20);
  }
}

TEST(Network, SourceThatThrowsIsThatScansProblem) {
  const auto site = park(3, 3);
  const NetworkOptions options = fast_options();
  const auto features = [&](std::size_t i) {
    if (i == 1) throw FileError("station_1.ply: cannot be opened");
    Options scaled = options.pair;
    scaled.scale.voxel_size = 0.5;
    return extract_features(site[i < 1 ? i : i - 1], scaled);
  };
  const Network network = register_network(3, features, options);
  EXPECT_EQ(network.scans[1].problem, "station_1.ply: cannot be opened");
  EXPECT_EQ(network.components[0], (std::vector<std::size_t>{0, 2}));
}

TEST(Network, RefusesWhatItCannotUse) {
  NetworkOptions options;
  options.min_unconfirmed_confidence = 0.3;
  EXPECT_THROW(register_network(std::span<const Scan>(), options), InvalidArgument);
  std::vector<Features> features(2);
  features[0].voxel_size = 1;
  features[1].voxel_size = 2;
  EXPECT_THROW(register_network(std::span<const Features>(features)), InvalidArgument);
  EXPECT_THROW(align(features[0], features[1]), InvalidArgument);
  options = {};
  options.pairs = PairRule::listed;
  const Points few = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Scan> scans(2, Scan{few});
  for (const ScanPair& pair : {ScanPair{0, 2}, ScanPair{1, 1}}) {
    options.listed_pairs = {pair};
    EXPECT_THROW(register_network(std::span<const Scan>(scans), options), InvalidArgument);
  }
  const Network nothing = register_network(std::span<const Scan>());
  EXPECT_TRUE(nothing.scans.empty());
  EXPECT_TRUE(nothing.components.empty());
}

TEST(Network, StopsWhenAsked) {
  const auto site = park(3, 2);
  const std::vector<Scan> scans = views(site);
  const auto stop = [](const Progress& progress) { return progress.stage != "pairs"; };
  EXPECT_THROW(register_network(std::span<const Scan>(scans), fast_options(), stop), Cancelled);
}

}  // namespace
}  // namespace igsp
