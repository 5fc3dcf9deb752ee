#include "network/survey_free_space.hpp"

#include <gtest/gtest.h>

#include "igsp/simulation.hpp"

namespace igsp {
namespace {

// Three stations of a building in a chain; the poses are true unless said otherwise.
struct Survey {
  std::vector<Features> features;
  std::vector<const Features*> views;
  Network network;

  explicit Survey(double unit = 1) {
    Options options;
    options.scale.voxel_size = 0.2 * unit;
    network.voxel_size = 0.2 * unit;
    for (const SimulatedScan& scan : simulate("indoor", {.stations = 3, .points = 20000, .seed = 4})) {
      Points points = scan.points;
      for (Eigen::Vector3d& point : points) point *= unit;
      features.push_back(extract_features({points, Eigen::Vector3d(*scan.viewpoint * unit)}, options));
      NetworkScan placed;
      placed.world_from_scan = scan.world_from_scanner;
      placed.world_from_scan.translation() *= unit;
      network.scans.push_back(placed);
    }
    for (const Features& one : features) views.push_back(&one);
    for (std::size_t i = 1; i < 3; ++i) {
      NetworkLink link;
      link.source = i;
      link.target = i - 1;
      link.state = LinkState::unconfirmed;
      link.confidence = i == 1 ? 0.97 : 0.99;
      network.links.push_back(link);
    }
  }
  std::optional<std::size_t> contradicted() {
    return SurveyFreeSpace(views, network.voxel_size).contradicted_link(network);
  }

  // The last station turned about where it stands: its walls now cut through the rooms that the others saw.
  void turn_last() { network.scans[2].world_from_scan.rotate(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ())); }
};

TEST(SurveyFreeSpace, FindsNothingAtTheTruth) {
  EXPECT_FALSE(Survey().contradicted());
}

TEST(SurveyFreeSpace, GivesUpTheLinkToAScanInTheWay) {
  Survey survey;
  survey.turn_last();
  survey.network.links[0].confidence = 1;
  EXPECT_EQ(survey.contradicted(), 1u);
}

TEST(SurveyFreeSpace, SaysTheSameInAnyUnitOfLength) {
  Survey survey(1e30);
  EXPECT_FALSE(survey.contradicted());
  survey.turn_last();
  EXPECT_TRUE(survey.contradicted());
}

TEST(SurveyFreeSpace, SaysNothingOfLinksInLoopsNorWithoutViewpoints) {
  Survey survey;
  survey.turn_last();
  for (NetworkLink& link : survey.network.links) link.state = LinkState::used;
  EXPECT_FALSE(survey.contradicted());
  for (NetworkLink& link : survey.network.links) link.state = LinkState::unconfirmed;
  for (Features& one : survey.features) one.viewpoint.reset();
  EXPECT_FALSE(survey.contradicted());
}

}  // namespace
}  // namespace igsp
