#include "network/decide.hpp"

#include <gtest/gtest.h>

namespace igsp {
namespace {

// Scans of 50 voxels, and links between neighbours that say exactly where the next one is.
struct Chain {
  Network network;
  std::vector<ScanShape> shapes;

  explicit Chain(std::size_t scans) : shapes(scans, {Eigen::Vector3d::Zero(), 5}) {
    network.voxel_size = 0.1;
    network.scans.resize(scans);
    for (std::size_t i = 1; i < scans; ++i) network.links.push_back(link(i, i - 1));
  }
  static NetworkLink link(std::size_t source, std::size_t target) {
    NetworkLink link;
    link.source = source;
    link.target = target;
    link.state = LinkState::unconfirmed;
    link.confidence = 0.99;
    link.mutual_matches = 200;
    link.agreeing_matches = 100;
    link.target_from_source.translation().x() = static_cast<double>(source) - static_cast<double>(target);
    return link;
  }
  const Network& decided(const NetworkOptions& options = {}) {
    decide(network, shapes, nullptr, options);
    return network;
  }
};

TEST(Decide, LinkInNoLoopJoinsAndIsUnconfirmed) {
  const Network network = Chain(2).decided();
  EXPECT_EQ(network.components.size(), 1u);
  EXPECT_EQ(network.links[0].state, LinkState::unconfirmed);
  EXPECT_NEAR(network.scans[1].world_from_scan.translation().x(), 1, 1e-9);
}

// Two rooms without furniture: confident, for the surfaces touch everywhere, on few matches.
TEST(Decide, FewMatchesInNoLoopDoNotJoin) {
  Chain chain(2);
  chain.network.links[0].mutual_matches = 34;
  chain.network.links[0].agreeing_matches = 17;
  NetworkOptions lenient;
  lenient.min_unconfirmed_matches = 10;
  EXPECT_EQ(Chain(chain).decided(lenient).components.size(), 1u);
  const Network network = chain.decided();
  EXPECT_EQ(network.components.size(), 2u);
  EXPECT_EQ(network.links[0].state, LinkState::rejected);
  EXPECT_NE(network.links[0].reason.find("17 agreeing matches are too few"), std::string::npos);
}

TEST(Decide, LowConfidenceInNoLoopDoesNotJoin) {
  Chain chain(2);
  chain.network.links[0].confidence = 0.8;
  const Network network = chain.decided();
  EXPECT_EQ(network.components.size(), 2u);
  EXPECT_NE(network.links[0].reason.find("a confidence of 0.80 is too low"), std::string::npos);
}

TEST(Decide, LowConfidenceJoinsWhereScannersSawNothingInTheWay) {
  Chain chain(2);
  chain.network.links[0].confidence = 0.6;
  chain.network.links[0].in_view = 400;
  EXPECT_EQ(Chain(chain).decided().components.size(), 1u);
  chain.network.links[0].violation = 0.01;
  EXPECT_EQ(Chain(chain).decided().components.size(), 2u);
  chain.network.links[0].violation = 0;
  chain.network.links[0].in_view = 20;
  EXPECT_EQ(Chain(chain).decided().components.size(), 2u);
}

TEST(Decide, RefusedPairJoinsOnlyWhereNothingSpeaksAgainstIt) {
  Chain chain(2);
  NetworkLink& refused = chain.network.links[0];
  refused.state = LinkState::not_registered;
  refused.reason = "too little to tell it from chance";
  refused.confidence = 0.2;
  EXPECT_EQ(Chain(chain).decided().links[0].reason, "too little to tell it from chance");
  EXPECT_EQ(Chain(chain).decided().components.size(), 2u);
  refused.in_view = 400;
  const Network joined = Chain(chain).decided();
  EXPECT_EQ(joined.components.size(), 1u);
  EXPECT_EQ(joined.links[0].state, LinkState::unconfirmed);
  EXPECT_EQ(joined.links[0].reason.find("refused as a pair"), 0u);
  refused.agreeing_matches = 20;
  EXPECT_EQ(Chain(chain).decided().components.size(), 2u);
}

// Scan 2 was put into a copy of the room of 0 and 1: both links agree, and both violate the free space.
TEST(Decide, DoubtfulLinksDoNotConfirmEachOther) {
  Chain chain(3);
  chain.network.links.push_back(Chain::link(2, 0));
  EXPECT_EQ(Chain(chain).decided().components.size(), 1u);
  for (const std::size_t wrong : {1, 2}) {
    chain.network.links[wrong].confidence = 0.66;
    chain.network.links[wrong].violation = 0.05;
  }
  const Network network = Chain(chain).decided();
  EXPECT_EQ(network.components, (std::vector<std::vector<std::size_t>>{{0, 1}, {2}}));
  EXPECT_NE(network.links[2].reason.find("no link without such a doubt"), std::string::npos);
  chain.network.links[2].violation = 0.001;
  EXPECT_EQ(chain.decided().components.size(), 1u);
}

// Refused as pairs and not contradicted: copies of a bare room, which agree with each other.
TEST(Decide, RefusedPairsDoNotConfirmEachOther) {
  Chain chain(3);
  chain.network.links.push_back(Chain::link(2, 0));
  for (NetworkLink& link : chain.network.links) {
    link.state = LinkState::not_registered;
    link.reason = "too little to tell it from chance";
    link.confidence = 0.3;
    link.agreeing_matches = 20;
    link.in_view = 400;
  }
  const Network network = chain.decided();
  EXPECT_EQ(network.components.size(), 3u);
  EXPECT_TRUE(network.cycles.empty());
  for (const NetworkLink& link : network.links) EXPECT_EQ(link.reason, "too little to tell it from chance");
}

TEST(Decide, LoopConfirmsLinksThatCouldNotStandAlone) {
  Chain chain(3);
  chain.network.links.push_back(Chain::link(2, 0));
  for (NetworkLink& link : chain.network.links) {
    link.confidence = 0.7;
    link.agreeing_matches = 20;
  }
  const Network network = chain.decided();
  EXPECT_EQ(network.components.size(), 1u);
  for (const NetworkLink& link : network.links) EXPECT_EQ(link.state, LinkState::used);
}

TEST(Decide, SpaceThatAScannerSawThroughForbidsALink) {
  Chain chain(2);
  chain.network.links[0].violation = 0.2;
  const Network network = chain.decided();
  EXPECT_EQ(network.components.size(), 2u);
  EXPECT_NE(network.links[0].reason.find("20 % of the points lie where"), std::string::npos);
}

}  // namespace
}  // namespace igsp
