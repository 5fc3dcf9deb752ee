#include "network/page.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "igsp/errors.hpp"

namespace igsp::cli {
namespace {

// A floor of 20 x 20 voxels of size 1, in survey coordinates.
Features level_floor() {
  Features features;
  features.origin = {4e6, 5e5, 200};
  features.voxel_size = 1;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) features.points.emplace_back(x, y, 0);
  }
  features.normals.assign(features.points.size(), Eigen::Vector3d::UnitZ());
  return features;
}

// Two floors in one frame, the second one 0.25 higher, half a voxel aside and 10 voxels along x; one floor by itself.
Network two_floors_and_one() {
  Network network;
  network.voxel_size = 1;
  network.scans.resize(3);
  network.scans[1].world_from_scan.translation() = Eigen::Vector3d(10.5, 0.5, 0.25);
  network.components = {{0, 1}, {2}};
  return network;
}

std::vector<DrawnScan> drawn_floors() {
  return {3, drawn_scan(level_floor(), 3)};
}

Json page_data(const Network& network) {
  const std::vector<DrawnScan> drawn(network.scans.size());
  const std::string page = network_page(network, {}, drawn), mark = "id=\"data\">";
  const std::size_t begin = page.find(mark) + mark.size();
  return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(MeasureDrawn, DistancesAreAlongTheNormalsOfOtherScansOfTheFrame) {
  std::vector<DrawnScan> drawn = drawn_floors();
  const auto features = [](std::size_t) { return level_floor(); };
  measure_drawn(drawn, two_floors_and_one(), features, 1);
  for (std::size_t p = 0; p < 400; ++p) {
    const float x = drawn[0].points[3 * p];
    if (x > 10) EXPECT_NEAR(drawn[0].distances[p], 0.25, 1e-5);
    if (x < 7) EXPECT_TRUE(std::isinf(drawn[0].distances[p])) << "no voxel of the other floor within 3";
  }
  EXPECT_EQ(drawn[2].distances.size(), 400u);
  for (const float distance : drawn[2].distances) EXPECT_TRUE(std::isinf(distance));
}

TEST(MeasureDrawn, ThreadsDoNotMatter) {
  std::vector<DrawnScan> one = drawn_floors(), several = one;
  const auto features = [](std::size_t) { return level_floor(); };
  measure_drawn(one, two_floors_and_one(), features, 1);
  measure_drawn(several, two_floors_and_one(), features, 4);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].distances, several[i].distances);
}

TEST(MeasureDrawn, AScanThatIsGoneLeavesThemUnknown) {
  std::vector<DrawnScan> drawn = drawn_floors();
  const auto features = [](std::size_t i) -> Features {
    if (i == 1) throw FileError("gone");
    return level_floor();
  };
  measure_drawn(drawn, two_floors_and_one(), features, 1);
  for (const DrawnScan& scan : drawn) EXPECT_TRUE(scan.distances.empty());
}

TEST(NetworkPage, LoopsThatDoNotCloseComeFirstAndOfManyTheWorst) {
  Network network;
  network.scans.resize(3);
  for (int i = 0; i < 300; ++i) network.cycles.push_back({{0, 1, 2}, i / 100.0, true});
  network.cycles.push_back({{0, 1, 2}, 5, false});
  network.cycles.push_back({{0, 1, 2}, 50, false});
  const Json loops = page_data(network)["loops"];
  EXPECT_EQ(loops["all"], 302);
  EXPECT_EQ(loops["closing"], 300);
  ASSERT_EQ(loops["shown"].size(), 200u);
  EXPECT_EQ(loops["shown"][0]["error"], 50);
  EXPECT_EQ(loops["shown"][1]["error"], 5);
  EXPECT_EQ(loops["shown"][2]["error"], 2.99);
}

TEST(NetworkPage, ContradictionsAreCountedAndTheWorstShown) {
  Network network;
  network.scans.resize(2);
  network.contradictions.assign(250, {{0, 1}, 0.02});
  network.contradictions.front().violation = 0.3;
  const Json contradictions = page_data(network)["contradictions"];
  EXPECT_EQ(contradictions["all"], 250);
  ASSERT_EQ(contradictions["shown"].size(), 200u);
  EXPECT_EQ(contradictions["shown"][0]["violation"], 0.3);
}

TEST(NetworkPage, SecondLooksAreNoPairsThatWereTried) {
  Network network;
  network.scans.resize(2);
  network.links.resize(2);
  network.links[1].origin = LinkOrigin::runner_up;
  EXPECT_EQ(page_data(network)["pairs_tried"], 1);
}

TEST(NetworkPage, AnAxisAlongAFreeDirectionHasNoSigma) {
  Network network;
  network.scans.resize(2);
  NetworkLink link;
  link.target = 1;
  network.links.push_back(link);
  EXPECT_TRUE(page_data(network)["links"][0]["translation_sigma"].is_null());
  Precision& precision = network.links[0].precision;
  precision.covariance.diagonal() << 1, 1, 1, 4, 9, 16;
  EXPECT_EQ(page_data(network)["links"][0]["translation_sigma"], Json({2.0, 3.0, 4.0}));
  FreeDirection along_y;
  along_y.motion << 0, 0, 0, 0, 1, 0;
  along_y.description = "translation along (0.00, 1.00, 0.00)";
  precision.free_directions.push_back(along_y);
  const Json shown = page_data(network)["links"][0];
  EXPECT_EQ(shown["translation_sigma"], Json({2.0, nullptr, 4.0}));
  EXPECT_EQ(shown["free_directions"][0], along_y.description);
}

}  // namespace
}  // namespace igsp::cli
