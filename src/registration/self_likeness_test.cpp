#include "registration/self_likeness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulation/random.hpp"

namespace igsp {
namespace {

constexpr double spacing = 0.02;

struct Box {
  Eigen::Vector3d centre, size;
  double turned_rad = 0;  // about z
};

void add_surface(const Box& box, simulation::Random& random, Features& features) {
  const Eigen::AngleAxisd turn(box.turned_rad, Eigen::Vector3d::UnitZ());
  for (int axis = 0; axis < 3; ++axis) {
    const double area = box.size.prod() / box.size[axis];
    for (const double side : {-0.5, 0.5}) {
      for (int i = 0; i < area / (spacing * spacing); ++i) {
        Eigen::Vector3d place{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
        place[axis] = side;
        features.points.push_back(turn * (box.centre + place.cwiseProduct(box.size)));
        features.normals.push_back(turn * Eigen::Vector3d::Unit(axis));
      }
    }
  }
}

// Moved away, so that nothing lies along an axis.
Features features_of(const std::vector<Box>& boxes) {
  simulation::Random random(5);
  Features features;
  for (const Box& box : boxes) add_surface(box, random, features);
  const Transformation away =
      Eigen::Translation3d(3, 1, 2) * Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized());
  for (Eigen::Vector3d& point : features.points) point = away * point;
  for (Eigen::Vector3d& normal : features.normals) normal = away.linear() * normal;
  features.voxel_size = spacing;
  return features;
}

std::vector<Box> table(double length, double width) {
  std::vector<Box> boxes{{{0, 0, 0.72}, {length, width, 0.03}}};
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      boxes.push_back({{x * (length - 0.1), y * (width - 0.1), 0.35}, {0.06, 0.06, 0.7}});
    }
  }
  return boxes;
}

std::vector<double> turns_in_degrees(const Features& features) {
  std::vector<double> degrees;
  for (const Transformation& turn : turns_onto_itself(PreparedCloud(features))) {
    degrees.push_back(Eigen::AngleAxisd(turn.linear()).angle() * 180 / std::numbers::pi);
  }
  return degrees;
}

std::vector<double> turns_of_boxes(const std::vector<Box>& boxes) {
  return turns_in_degrees(features_of(boxes));
}

// The farther from the place, the fewer of its points are left.
Features seen_from(const Features& features, const Eigen::Vector3d& place) {
  simulation::Random random(6);
  Features seen;
  seen.voxel_size = features.voxel_size;
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    if (random.uniform(0, 1) * (features.points[i] - place).squaredNorm() > 0.2) continue;
    seen.points.push_back(features.points[i]);
    seen.normals.push_back(features.normals[i]);
  }
  return seen;
}

TEST(SelfLikeness, ATableLiesOnItselfAfterHalfATurn) {
  const std::vector<double> turns = turns_of_boxes(table(1.6, 0.9));
  ASSERT_EQ(turns.size(), 1u);
  EXPECT_NEAR(turns[0], 180, 2);
}

TEST(SelfLikeness, ThreeLegsAfterAThird) {
  std::vector<Box> legs;
  for (int i = 0; i < 3; ++i) legs.push_back({{0.4, 0, 0}, {0.6, 0.12, 0.2}, i * 2 * std::numbers::pi / 3});
  const std::vector<double> turns = turns_of_boxes(legs);
  ASSERT_EQ(turns.size(), 1u);
  EXPECT_NEAR(turns[0], 120, 2);
}

TEST(SelfLikeness, FiveLegsAfterFifthsAndTurnedOver) {
  std::vector<Box> legs;
  for (int i = 0; i < 5; ++i) legs.push_back({{0.4, 0, 0}, {0.6, 0.12, 0.2}, i * 2 * std::numbers::pi / 5});
  const std::vector<double> turns = turns_of_boxes(legs);
  ASSERT_FALSE(turns.empty());
  for (const double turn : turns) EXPECT_NEAR(std::remainder(turn, 36), 0, 2);
}

TEST(SelfLikeness, ABoxAfterHalfATurnAboutEachOfItsAxes) {
  EXPECT_EQ(turns_of_boxes({{{0, 0, 0}, {1.5, 0.8, 0.4}}}).size(), 3u);
}

TEST(SelfLikeness, ATableWithALampDoesNot) {
  std::vector<Box> boxes = table(1.6, 0.9);
  boxes.push_back({{0.5, 0.2, 1.0}, {0.4, 0.4, 0.6}});
  EXPECT_TRUE(turns_of_boxes(boxes).empty());
}

// Its principal axes are tilted and its centroid is not where it turns.
TEST(SelfLikeness, AnEmptySquareRoomSeenFromACornerDoes) {
  std::vector<Box> boxes{{{0, 0, 0}, {2, 2, 0.9}}};
  Features room = features_of(boxes);
  const std::vector<double> turns = turns_in_degrees(seen_from(room, room.points[0]));
  ASSERT_FALSE(turns.empty());
  for (const double turn : turns) EXPECT_NEAR(std::remainder(turn, 90), 0, 1);
  boxes.push_back({{0.3, 0.85, -0.1}, {0.5, 0.25, 0.7}});  // a wardrobe
  room = features_of(boxes);
  EXPECT_TRUE(turns_in_degrees(seen_from(room, room.points[0])).empty());
}

// Its box is less than a hundredth of the points, and all that there is to recognise.
TEST(SelfLikeness, AFieldWithABoxDoesNot) {
  const Features flat = features_of({{{0, 0, 0}, {4, 3, 0.2}}});
  EXPECT_FALSE(turns_onto_itself(PreparedCloud(flat)).empty());
  Features field = flat;
  for (std::uint32_t i = 0; i < 20; ++i) {
    field.keypoints.push_back(static_cast<std::uint32_t>(field.points.size()));
    field.points.push_back(flat.points[0] + 0.2 * flat.normals[0] * (1 + 0.05 * i));
    field.normals.push_back(flat.normals[0]);
  }
  EXPECT_TRUE(turns_onto_itself(PreparedCloud(field)).empty());
}

TEST(SelfLikeness, NothingDoesNot) {
  EXPECT_TRUE(turns_of_boxes({}).empty());
}

}  // namespace
}  // namespace igsp
