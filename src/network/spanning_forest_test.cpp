#include "network/spanning_forest.hpp"

#include <gtest/gtest.h>

#include <map>

#include "network/network_testing.hpp"

namespace igsp {
namespace {

using namespace network_testing;

// Scans 0, 1 and 2, 3 in a frame each, and a link from 2 to 1.
struct TwoFrames {
  std::vector<Transformation> truth;
  LinkGraph graph;

  TwoFrames() {
    Dice dice(11);
    for (int i = 0; i < 4; ++i) truth.push_back(dice.pose(50));
    graph.centres.resize(4, Eigen::Vector3d::Zero());
    for (const auto& [source, target] : {std::pair(1, 0), std::pair(3, 2), std::pair(2, 1)}) {
      graph.links.push_back(link_between(truth, source, target));
    }
    joining().weight = 1;
  }
  GraphLink& joining() { return graph.links[2]; }
  Forest forest(const WitnessQuestion& ask = {}) const {
    return spanning_forest(graph, cycle_support(graph, triangles(graph)), ask);
  }
};

WitnessQuestion all_say(Witness witness) {
  return [=](std::size_t, std::size_t, const Transformation&) { return witness; };
}

TEST(SpanningForest, AsksEveryOtherPairOfScansWhereTheLinkPutsIt) {
  const TwoFrames frames;
  std::map<std::pair<std::size_t, std::size_t>, int> asked;
  const auto ask = [&](std::size_t source, std::size_t target, const Transformation& target_from_source) {
    ++asked[{source, target}];
    const Transformation truth = frames.truth[target].inverse() * frames.truth[source];
    EXPECT_LT((target_from_source.matrix() - truth.matrix()).norm(), 1e-9) << source << " to " << target;
    return Witness::none;
  };
  EXPECT_EQ(frames.forest(ask).links, (std::vector<std::size_t>{0, 1, 2}));
  const std::map<std::pair<std::size_t, std::size_t>, int> others = {{{2, 0}, 1}, {{3, 0}, 1}, {{3, 1}, 1}};
  EXPECT_EQ(asked, others);
}

TEST(SpanningForest, AWitnessAgainstItKeepsALinkFromJoining) {
  TwoFrames frames;
  const auto one_against = [](std::size_t source, std::size_t target, const Transformation&) {
    return source == 3 && target == 1 ? Witness::against : Witness::in_favour;
  };
  const Forest apart = frames.forest(one_against);
  EXPECT_EQ(apart.links, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(apart.is_contradicted, (std::vector<bool>{false, false, true}));
  // What a loop confirms asks nobody.
  frames.graph.links.push_back(link_between(frames.truth, 3, 1));
  EXPECT_EQ(frames.forest(one_against).links.size(), 3u);
}

TEST(SpanningForest, AWeakLinkJoinsWithAsManyWitnessesAsItNeeds) {
  TwoFrames frames;
  frames.joining().may_stand_alone = false;
  EXPECT_EQ(frames.forest(all_say(Witness::in_favour)).links.size(), 2u);
  frames.joining().witnesses_needed = 3;
  EXPECT_EQ(frames.forest(all_say(Witness::in_favour)).links.size(), 3u);
  EXPECT_EQ(frames.forest(all_say(Witness::none)).links.size(), 2u);
  EXPECT_EQ(frames.forest().links.size(), 2u) << "nobody to ask";
  frames.joining().witnesses_needed = 4;
  EXPECT_EQ(frames.forest(all_say(Witness::in_favour)).links.size(), 2u);
}

TEST(SpanningForest, OneDoubtIsTooMuchForALinkThatNeedsWitnesses) {
  TwoFrames frames;
  const auto one_doubts = [](std::size_t source, std::size_t target, const Transformation&) {
    return source == 3 && target == 1 ? Witness::doubtful : Witness::in_favour;
  };
  EXPECT_EQ(frames.forest(one_doubts).links.size(), 3u);
  frames.joining().may_stand_alone = false;
  frames.joining().witnesses_needed = 1;
  EXPECT_EQ(frames.forest(all_say(Witness::in_favour)).links.size(), 3u);
  EXPECT_EQ(frames.forest(one_doubts).links.size(), 2u);
}

// Of two weak links that say different things the one that a witness is against is no rival.
TEST(SpanningForest, WeakLinksThatDisagreeHearTheWitnessesAgainstThem) {
  TwoFrames frames;
  frames.joining().may_stand_alone = false;
  frames.joining().witnesses_needed = 1;
  GraphLink other = frames.joining();
  other.target_from_source.translation().x() += 20;
  frames.graph.links.push_back(other);
  // Scans 3 and 0, which are beside each other only once both frames are whole.
  const auto against_the_other = [&](std::size_t source, std::size_t target, const Transformation& target_from_source) {
    const Transformation truth = frames.truth[target].inverse() * frames.truth[source];
    const bool is_right = (target_from_source.matrix() - truth.matrix()).norm() < 1e-6;
    return is_right || source + target != 3 ? Witness::in_favour : Witness::against;
  };
  EXPECT_EQ(frames.forest(all_say(Witness::in_favour)).links.size(), 2u);
  EXPECT_EQ(frames.forest(against_the_other).links, (std::vector<std::size_t>{0, 1, 2}));
}

// Two links that say the same confirm each other, but not where both were refused as pairs.
TEST(SpanningForest, RefusedLinksConfirmNothing) {
  TwoFrames frames;
  frames.graph.links.push_back(link_between(frames.truth, 3, 1));
  for (const std::size_t l : {2, 3}) frames.graph.links[l].may_stand_alone = false;
  EXPECT_EQ(frames.forest().links.size(), 3u);
  for (const std::size_t l : {2, 3}) frames.graph.links[l].confirms_nothing = true;
  EXPECT_EQ(frames.forest().links.size(), 2u);
}

}  // namespace
}  // namespace igsp
