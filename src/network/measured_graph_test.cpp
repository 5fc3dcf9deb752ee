#include "network/measured_graph.hpp"

#include <gtest/gtest.h>

namespace igsp {
namespace {

SeenTogether seen(std::size_t contradicting, std::size_t meeting) {
  return {{FreeSpaceViolation{980, contradicting}, FreeSpaceViolation{980, 0}}, meeting};
}

TEST(MeasuredGraph, WitnessesInFavourMeetAndHaveNothingInTheWay) {
  EXPECT_EQ(witness_of(seen(0, 30)), Witness::in_favour);
  EXPECT_EQ(witness_of(seen(2, 1000)), Witness::in_favour);
  EXPECT_EQ(witness_of(seen(5, 1000)), Witness::none);
  EXPECT_EQ(witness_of(seen(20, 1000)), Witness::doubtful);
  EXPECT_EQ(witness_of(seen(70, 1000)), Witness::against);
}

// A scan that was put far outside of a building is in view of its scanners, behind the walls, and contradicts nothing.
TEST(MeasuredGraph, ScansThatAreHiddenFromEachOtherBearNoWitness) {
  EXPECT_EQ(witness_of(seen(0, 0)), Witness::none);
  EXPECT_EQ(witness_of(seen(0, 29)), Witness::none);
}

// Two bare rooms of one size lie on each other in four ways, and a corridor anywhere along another one.
TEST(MeasuredGraph, ARefusedPairMayBeRightOnlyWhereTheSurfacesFixIt) {
  NetworkLink link;
  link.confidence = 0.3;
  link.agreeing_matches = 40;
  link.in_view = 1000;
  EXPECT_TRUE(may_be_right(link, {}));
  link.confidence = 0.1;
  EXPECT_FALSE(may_be_right(link, {})) << "it was refused for what cannot be";
  link.confidence = 0.3;
  link.precision.free_directions.emplace_back();
  EXPECT_FALSE(may_be_right(link, {}));
}

}  // namespace
}  // namespace igsp
