#include "registration/pose_assessment.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace igsp {
namespace {

PoseAssessment pose_with(double overlap, std::size_t agreeing) {
  PoseAssessment pose;
  pose.source_on_target.overlap = overlap, pose.target_on_source.overlap = overlap;
  pose.agreeing_matches = agreeing;
  return pose;
}

TEST(DemandedQuality, GrowsWithTheOverlapOnEveryRung) {
  for (const std::size_t rung : {0u, 1u, 3u}) {
    EXPECT_NEAR(demanded_quality(pose_with(0.3, 50), rung), 0, 1e-12);
    EXPECT_NEAR(demanded_quality(pose_with(0.5, 50), rung), 0.3, 1e-12);
    EXPECT_NEAR(demanded_quality(pose_with(0.9, 50), rung), 0.9, 1e-12);
  }
}

TEST(DemandedQuality, IsADecadeMoreWhereFewFeaturesAgreeOnLargeVoxels) {
  EXPECT_NEAR(demanded_quality(pose_with(0.3, 5), 0), 0, 1e-12);
  EXPECT_NEAR(demanded_quality(pose_with(0.3, 13), 1), 0, 1e-12);
  EXPECT_NEAR(demanded_quality(pose_with(0.3, 12), 1), 1.0 / 3, 1e-12);
  EXPECT_NEAR(demanded_quality(pose_with(0.3, 10), 2), 1, 1e-12);
  EXPECT_NEAR(demanded_quality(pose_with(0.3, 0), 1), 1, 1e-12);
}

TEST(PoseAssessment, OddsAreEvenAtTheDemandedQuality) {
  PoseAssessment pose = pose_with(0.3, 20);
  pose.quality = 1.2, pose.demanded = 1.2;
  EXPECT_NEAR(pose.chance_odds(), 1, 1e-12);
  pose.quality = 3.2;
  EXPECT_NEAR(pose.chance_odds(), 0.01, 1e-12);
}

}  // namespace
}  // namespace igsp
