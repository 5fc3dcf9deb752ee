#include "registration/facing.hpp"

#include <gtest/gtest.h>

namespace igsp {
namespace {

using Eigen::Vector3d;

TEST(Facing, ANormalLooksAtTheScannerOrAwayFromIt) {
  const Vector3d point(5, 0, 0), normal = Vector3d::UnitX();
  const auto facing = [&](const Vector3d& viewpoint) { return SeenPlace{point, normal, &viewpoint}.facing(); };
  EXPECT_EQ(facing(Vector3d(7, 1, 0)), 1);
  EXPECT_EQ(facing(Vector3d(3, 1, 0)), -1);
  EXPECT_EQ(facing(Vector3d(5.1, 3, 0)), 0) << "at a grazing angle";
  EXPECT_EQ((SeenPlace{point, normal, nullptr}.facing()), 0);
}

}  // namespace
}  // namespace igsp
