#include "network/likely_pairs.hpp"

#include <gtest/gtest.h>

#include "igsp/simulation.hpp"
#include "network/likeness.hpp"
#include "network/shared_space.hpp"

namespace igsp {
namespace {

// Three stations of one park, then two of another one.
struct Sites {
  std::vector<SimulatedScan> scans =
      simulate("park", {.stations = 3, .points = 20000, .station_distance = 8, .seed = 3});
  std::vector<Features> features;
  std::vector<std::vector<Descriptor>> voters;

  Sites() {
    for (const SimulatedScan& scan : simulate("park", {.stations = 2, .points = 20000, .seed = 11}))
      scans.push_back(scan);
    Options options;
    options.scale.voxel_size = 0.6;
    for (const SimulatedScan& scan : scans) features.push_back(extract_features(scan, options));
    for (const Features& one : features) voters.push_back(voters_of(one));
  }
};

TEST(Likeness, IsHighestWithinASiteWhateverTheThreads) {
  const Sites sites;
  const std::vector<double> likeness = likeness_of_scans(sites.voters, 6, 1);
  const auto of = [&](std::size_t i, std::size_t j) { return likeness[5 * i + j]; };
  for (const std::size_t i : {0, 1, 2}) {
    for (const std::size_t j : {0, 1, 2}) {
      if (i == j) continue;
      EXPECT_GT(of(i, j), of(i, 3));
      EXPECT_GT(of(i, j), of(i, 4));
    }
  }
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_GT(of(3, 4), i < 3 ? of(3, i) : 0);
    for (std::size_t j = 0; j < 5; ++j) EXPECT_EQ(of(i, j), of(j, i));
  }
  EXPECT_EQ(likeness_of_scans(sites.voters, 6, 3), likeness);
}

TEST(Likeness, OfScansWithoutKeypointsIsNone) {
  const Sites sites;
  const std::vector<std::vector<Descriptor>> voters = {sites.voters[0], voters_of({}), sites.voters[1]};
  const std::vector<double> likeness = likeness_of_scans(voters, 4, 1);
  EXPECT_EQ(likeness[1], 0);
  EXPECT_EQ(likeness[5], 0);
}

TEST(SharedSpace, IsWholeAtTheSamePlaceAndNothingFarAway) {
  const Sites sites;
  const Space first(sites.features[0]), second(sites.features[1]), other(sites.features[3]);
  const Transformation here = Transformation::Identity();
  EXPECT_EQ(shared_space(first, here, first, here), 1);
  Transformation away = here;
  away.translation().x() = 1e4;
  EXPECT_EQ(shared_space(first, here, second, away), 0);
  away.translation().x() = 1e300;
  EXPECT_EQ(shared_space(first, here, second, away), 0);
  const double share =
      shared_space(first, sites.scans[0].world_from_scanner, second, sites.scans[1].world_from_scanner);
  EXPECT_GT(share, 0.5);
  EXPECT_EQ(shared_space(second, sites.scans[1].world_from_scanner, first, sites.scans[0].world_from_scanner), share);
  EXPECT_LT(shared_space(first, sites.scans[0].world_from_scanner, second, sites.scans[0].world_from_scanner), share);
}

}  // namespace
}  // namespace igsp
