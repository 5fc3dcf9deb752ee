#include "registration/viewpoints.hpp"

#include <gtest/gtest.h>

namespace igsp {
namespace {

using Eigen::Vector3d;

TEST(Viewpoints, AreUnknownOrOneForAllPoints) {
  EXPECT_EQ(Viewpoints().of(3), nullptr);
  const Viewpoints one(Vector3d(1, 2, 3));
  ASSERT_NE(one.of(0), nullptr);
  EXPECT_EQ(*one.of(0), Vector3d(1, 2, 3));
  EXPECT_EQ(one.of(7), one.of(0));
}

TEST(Viewpoints, OfSeveralScansThatOfTheNearestPointSawIt) {
  Features cloud;
  cloud.voxel_size = 0.1;
  cloud.parts = {{Vector3d(-5, 0, 0), {{0, 0, 0}, {0, 1, 0}}}, {Vector3d(5, 0, 0), {{0.2, 0, 0}, {0.2, 1, 0}}}};
  const Points points{{0.02, 0, 0}, {0.21, 1.05, 0}, {0, 1, 0.1}, {3, 0, 0}};
  const Viewpoints viewpoints(cloud, points);
  ASSERT_NE(viewpoints.of(0), nullptr);
  EXPECT_EQ(*viewpoints.of(0), Vector3d(-5, 0, 0));
  ASSERT_NE(viewpoints.of(1), nullptr);
  EXPECT_EQ(*viewpoints.of(1), Vector3d(5, 0, 0));
  ASSERT_NE(viewpoints.of(2), nullptr);
  EXPECT_EQ(*viewpoints.of(2), Vector3d(-5, 0, 0));
  EXPECT_EQ(viewpoints.of(3), nullptr) << "of a scan whose scanner is not known";
}

}  // namespace
}  // namespace igsp
