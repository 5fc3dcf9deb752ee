#include "registration/rivals.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace igsp {
namespace {

Rival at(double x, double quality) {
  Rival rival{Transformation(Eigen::Translation3d(x, 0, 0)), {}};
  rival.assessment.quality = quality;
  return rival;
}

// Where nothing overlaps, nothing is demanded of it, and the odds of chance are 10^-Q.
TEST(Rivals, ShareTheConfidenceWithChanceAndThePose) {
  EXPECT_DOUBLE_EQ(confidence_of(at(0, 0).assessment, 0), 0.5);
  EXPECT_DOUBLE_EQ(confidence_of(at(0, 1).assessment, 0), 1 / 1.1);
  EXPECT_DOUBLE_EQ(confidence_of(at(0, 0).assessment, 2), 0.25);
  EXPECT_DOUBLE_EQ(confidence_of(at(0, 1).assessment, 0.4), 1 / 1.5);
}

TEST(Rivals, OddsAreTheDecadesOfTheirQuality) {
  const PoseAssessment answer = at(0, 1).assessment;
  EXPECT_DOUBLE_EQ(odds_of(std::vector{at(10, 0)}, answer), 0.1);
  EXPECT_DOUBLE_EQ(odds_of(std::vector{at(10, 0), at(20, 2)}, answer), 10.1);
  EXPECT_EQ(odds_of({}, answer), 0);
  // Both are beyond doubt, and which is better is noise.
  EXPECT_DOUBLE_EQ(odds_of(std::vector{at(10, 4)}, at(0, 3).assessment), 1);
}

TEST(Rivals, ASmallLeadDecidesNothing) {
  const PoseAssessment answer = at(0, 1).assessment;
  EXPECT_DOUBLE_EQ(odds_of(std::vector{at(10, 0.5)}, answer, 0.6), 1);
  EXPECT_DOUBLE_EQ(odds_of(std::vector{at(10, 0)}, answer, 0.6), 0.1);
  EXPECT_DOUBLE_EQ(odds_of(std::vector{at(10, 1.2)}, answer, 0.6), std::pow(10, 0.2)) << "it is behind";
}

TEST(Rivals, AreDistinctFromTheAnswerAndFromEachOther) {
  const std::vector<Rival> found{at(0.3, 2), at(10, 1), at(10.3, 0.5), at(20, 0)};
  const std::vector<Rival> distinct = distinct_rivals(found, Transformation::Identity(), 0.1);
  ASSERT_EQ(distinct.size(), 2u);
  EXPECT_EQ(distinct[0].assessment.quality, 1);
  EXPECT_EQ(distinct[1].assessment.quality, 0);
}

TEST(Rivals, OfAnotherRungContradictWhereTheyWeigh) {
  const Rival answer = at(0, 3);
  const double v = 0.1;
  EXPECT_DOUBLE_EQ(contradiction_by(std::vector{at(10, 1.5), at(0, 0.5)}, answer, v), 10);
  EXPECT_EQ(contradiction_by(std::vector{at(0, 0.5), at(10, 0.1)}, answer, v), 0) << "odds of 0.4 are undecided";
  EXPECT_DOUBLE_EQ(contradiction_by(std::vector{at(10, 1)}, answer, v), 10) << "the answer is no better than chance";
  EXPECT_EQ(contradiction_by(std::vector{at(10, -0.1), at(0, -2)}, answer, v), 0) << "chance speaks for the other one";
}

}  // namespace
}  // namespace igsp
