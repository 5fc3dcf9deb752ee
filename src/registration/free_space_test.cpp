#include "registration/free_space.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "core/core_testing.hpp"
#include "registration/pose_assessment.hpp"

namespace igsp {
namespace {

using Eigen::Vector3d;
using testing::Random;

constexpr double voxel_size = 0.08;

/// Boxes, and a scanner that turns once around.
struct Boxes {
  std::vector<Eigen::AlignedBox3d> solids;

  double first_hit(const Vector3d& eye, const Vector3d& direction) const {
    double first = std::numeric_limits<double>::infinity();
    for (const Eigen::AlignedBox3d& box : solids) {
      const Eigen::Array3d low = (box.min() - eye).array() / direction.array();
      const Eigen::Array3d high = (box.max() - eye).array() / direction.array();
      const double enter = low.min(high).maxCoeff(), leave = low.max(high).minCoeff();
      if (enter > 0 && enter <= leave) first = std::min(first, enter);
    }
    return first;
  }

  Points seen_from(const Vector3d& eye, Random random) const {
    Points points;
    for (int i = 0; i < 60000; ++i) {
      const Vector3d direction = random.direction();
      const double range = first_hit(eye, direction) + 0.003 * random.normal();
      if (std::isfinite(range)) points.push_back(eye + range * direction);
    }
    return points;
  }
};

Eigen::AlignedBox3d box(double x0, double y0, double z0, double x1, double y1, double z1) {
  return {Vector3d(x0, y0, z0), Vector3d(x1, y1, z1)};
}

/// Two rooms of 6 m x 5 m side by side, x < 0 and x > 0, a door in the wall between them, other furniture in each.
Boxes two_rooms() {
  return {{box(-6, 0, -0.2, 6, 5, 0), box(-6, 0, 3, 6, 5, 3.2),  // floor, ceiling
           box(-6, -0.2, 0, 6, 0, 3), box(-6, 5, 0, 6, 5.2, 3),  // long walls
           box(-6.2, 0, 0, -6, 5, 3), box(6, 0, 0, 6.2, 5, 3),   // short walls
           box(-0.1, 0, 0, 0.1, 3.5, 3), box(-0.1, 4.5, 0, 0.1, 5, 3),
           box(-0.1, 3.5, 2.1, 0.1, 4.5, 3),  // with the door
           box(-5, 0, 0, -4, 0.6, 2.2), box(-3.2, 2, 0, -1.6, 2.9, 0.75), box(-6, 4, 0, -5.2, 5, 1.2),
           box(1, 1, 0, 1.8, 2.6, 0.9), box(4.6, 0, 0, 6, 2, 0.5), box(3, 4.3, 0, 4.2, 5, 2),
           box(3.6, 2.4, 0, 4.4, 3.2, 1.1)}};
}
const Vector3d left_eye(-2, 3.8, 1.5), right_eye(2.2, 3.6, 1.5);

struct Cloud {
  Cloud(const Scan& scan) : features(extract_features(scan, options())) {}
  static Options options() {
    Options options;
    options.threads = 1;
    options.scale.voxel_size = voxel_size;
    return options;
  }
  Features features;
};

/// Of two scans given in one frame, when the first is moved by `motion`.
FreeSpace violations(const Scan& source, const Scan& target,
                     const Transformation& motion = Transformation::Identity()) {
  const Cloud a(source), b(target);
  Transformation local = motion;  // between the centred clouds
  local.translation() = motion * a.features.origin - b.features.origin;
  return PairSpace(a.features, b.features).at(local);
}

Transformation shift(double x, double y, double z) {
  return Transformation(Eigen::Translation3d(x, y, z));
}

TEST(FreeSpace, AScanDoesNotContradictItself) {
  const Points scan = two_rooms().seen_from(left_eye, Random(1));
  const FreeSpace f = violations({scan, left_eye}, {scan, left_eye});
  ASSERT_TRUE(f.source && f.target);
  EXPECT_EQ(f.source->contradicting, 0u);
  EXPECT_EQ(f.target->contradicting, 0u);
  EXPECT_GT(f.source->in_view, 800u);
  EXPECT_EQ(f.violation(), 0);
}

TEST(FreeSpace, TwoRoomsWithAWallBetweenThem) {
  const Points left = two_rooms().seen_from(left_eye, Random(1)), right = two_rooms().seen_from(right_eye, Random(2));
  const Scan source{left, left_eye}, target{right, right_eye};
  EXPECT_LT(violations(source, target).violation(), 0.003);
  // One room in the place of the other, as it is or turned: floor, walls and ceiling touch.
  EXPECT_GT(violations(source, target, shift(6, 0, 0)).violation(), 0.05);
  const Eigen::AngleAxisd half_turn(std::numbers::pi, Vector3d::UnitZ());
  EXPECT_GT(violations(source, target, shift(0, 5, 0) * half_turn).violation(), 0.03);
}

// In view, and yet it says nothing of where it lies: what is hidden by a wall.
TEST(FreeSpace, WhatIsHiddenBehindAWallDoesNotMeetIt) {
  const Points scan = two_rooms().seen_from(left_eye, Random(1));
  const Cloud cloud(Scan{scan, left_eye});
  const ScannedSpace space(cloud.features);
  const auto met = [&](double x) { return space.met_by(space, shift(x, 0, 0), 1000); };
  EXPECT_GE(met(0), 1000u);
  EXPECT_EQ(met(-30), 0u);
  EXPECT_EQ(space.violation_by(space, shift(-30, 0, 0), 1000)->contradicting, 0u);
  EXPECT_GT(space.violation_by(space, shift(-30, 0, 0), 1000)->in_view, 800u);
}

TEST(FreeSpace, APersonWhoWalksThroughIsForgiven) {
  Boxes busy = two_rooms();
  busy.solids.push_back(box(-3.9, 3.2, 0, -3.4, 3.6, 1.8));
  const Vector3d other_eye(-4.4, 1.5, 1.5);
  const Points empty_room = two_rooms().seen_from(left_eye, Random(1)),
               with_person = busy.seen_from(other_eye, Random(2));
  const FreeSpace f = violations({with_person, other_eye}, {empty_room, left_eye});
  EXPECT_GT(f.source->contradicting, 0u);
  EXPECT_LT(f.violation(), 0.03);
}

TEST(FreeSpace, AViewpointWrongByAMetreStillRefutesTheNeighboursRoom) {
  const Points left = two_rooms().seen_from(left_eye, Random(1)), right = two_rooms().seen_from(right_eye, Random(2));
  const Scan source{left, left_eye + Vector3d(-1, 0, 0)}, target{right, right_eye + Vector3d(0, -1, 0)};
  EXPECT_GT(violations(source, target, shift(6, 0, 0)).violation(), 0.05);
}

TEST(FreeSpace, WithoutAViewpointNothingIsSaid) {
  const Points left = two_rooms().seen_from(left_eye, Random(1)), right = two_rooms().seen_from(right_eye, Random(2));
  const FreeSpace none = violations(left, right, shift(6, 0, 0));
  EXPECT_FALSE(none.source || none.target);
  EXPECT_EQ(none.violation(), 0);
  const FreeSpace half = violations(left, {right, right_eye}, shift(6, 0, 0));
  EXPECT_TRUE(half.source);
  EXPECT_FALSE(half.target);
  EXPECT_GT(half.violation(), 0.03);
}

TEST(FreeSpace, DoesNotDependOnTheFrame) {
  Random random(7);
  const Points left = two_rooms().seen_from(left_eye, Random(1)), right = two_rooms().seen_from(right_eye, Random(2));
  const FreeSpace here = violations({left, left_eye}, {right, right_eye}, shift(6, 0, 0));
  const Transformation g = random.motion(100), h = random.motion(100);
  const FreeSpace there = violations({testing::moved(g, left), g * left_eye}, {testing::moved(h, right), h * right_eye},
                                     h * shift(6, 0, 0) * g.inverse());
  EXPECT_NEAR(there.source->share(), here.source->share(), 0.02);  // other voxels
  EXPECT_NEAR(there.target->share(), here.target->share(), 0.02);
}

/// Scans one after the other, as one cloud.
struct Fused {
  void add(const Points& scan, const std::optional<Vector3d>& viewpoint) {
    points.insert(points.end(), scan.begin(), scan.end());
    parts.push_back({scan.size(), viewpoint});
  }
  Scan scan() const {
    Scan fused(points);
    fused.parts = parts;
    return fused;
  }
  Points points;
  std::vector<ScanPart> parts;
};

/// Of a station in each of the two rooms.
Fused both_rooms(const std::optional<Vector3d>& left, const std::optional<Vector3d>& right) {
  Fused fused;
  fused.add(two_rooms().seen_from(left_eye, Random(1)), left);
  fused.add(two_rooms().seen_from(right_eye, Random(2)), right);
  return fused;
}

TEST(FreeSpace, ACloudOfSeveralScansDoesNotContradictItself) {
  const Fused fused = both_rooms(left_eye, right_eye);
  const FreeSpace f = violations(fused.scan(), fused.scan());
  ASSERT_TRUE(f.source && f.target);
  EXPECT_EQ(f.violation(), 0);
  EXPECT_GT(f.source->in_view, 800u);
}

TEST(FreeSpace, WhatOneOfSeveralScannersSawThroughIsEmpty) {
  const Points again = two_rooms().seen_from(Vector3d(-4.4, 1.5, 1.5), Random(3));  // of the left room
  const auto violation = [&](const auto& left, const auto& right, const Transformation& motion) {
    const Fused fused = both_rooms(left, right);
    return violations(again, fused.scan(), motion).violation();
  };
  const Transformation still = Transformation::Identity(), next_door = shift(6, 0, 0);
  EXPECT_LT(violation(left_eye, right_eye, still), 0.01);
  EXPECT_GT(violation(left_eye, right_eye, next_door), 0.05);
  EXPECT_GT(violation(std::nullopt, right_eye, next_door), 0.05);
  EXPECT_LT(violation(left_eye, std::nullopt, next_door), 0.02);  // who sees nothing of that room cannot say
}

// A scanner sees through what it saw, not through what only another one did.
TEST(FreeSpace, EachScannerAnswersForItsOwnPointsAlone) {
  const Points near = Boxes{{box(2, -1, -1, 2.1, 1, 1)}}.seen_from(Vector3d::Zero(), Random(1)),
               far = Boxes{{box(6, -3, -3, 6.1, 3, 3)}}.seen_from(Vector3d(4, 0, 0), Random(2));
  Fused fused;
  fused.add(near, Vector3d::Zero());
  fused.add(far, Vector3d(4, 0, 0));
  Points pane;  // between both, behind the one wall and before the other
  for (double y = -0.5; y < 0.5; y += 0.02)
    for (double z = -0.5; z < 0.5; z += 0.02) pane.push_back({5, y, z});
  const FreeSpace f = violations(pane, fused.scan());
  EXPECT_GT(f.source->in_view, 100u);
  EXPECT_EQ(f.source->contradicting, f.source->in_view);
  fused.parts[1].viewpoint.reset();
  EXPECT_EQ(violations(pane, fused.scan()).source->contradicting, 0u);
}

TEST(FreeSpace, TheOrderOfThePartsIsNothing) {
  const Points again = two_rooms().seen_from(Vector3d(-4.4, 1.5, 1.5), Random(3));
  const Fused fused = both_rooms(left_eye, right_eye);
  Fused turned;
  turned.add(Points(fused.points.begin() + static_cast<std::ptrdiff_t>(fused.parts[0].points), fused.points.end()),
             right_eye);
  turned.add(Points(fused.points.begin(), fused.points.begin() + static_cast<std::ptrdiff_t>(fused.parts[0].points)),
             left_eye);
  const FreeSpace one = violations(again, fused.scan(), shift(6, 0, 0)),
                  other = violations(again, turned.scan(), shift(6, 0, 0));
  EXPECT_EQ(one.source->in_view, other.source->in_view);
  EXPECT_EQ(one.source->contradicting, other.source->contradicting);
}

TEST(FreeSpace, FewInViewSayLittle) {
  EXPECT_LT((FreeSpaceViolation{2, 2}).share(), 0.1);
  EXPECT_GT((FreeSpaceViolation{1000, 1000}).share(), 0.95);
  EXPECT_EQ((FreeSpaceViolation{}).share(), 0);
}

TEST(FreeSpace, EvidenceIsForWhatIsEmptyAndAgainstWhatIsNot) {
  EXPECT_EQ(free_space_evidence({}, 1, 1), 0);  // to the bit: without viewpoints two questions decide
  const FreeSpaceViolation none{1000, 0}, some{1000, 10}, people{1000, 36}, wall{1000, 300};
  const auto evidence = [](auto... directions) { return free_space_evidence(FreeSpace{directions...}, 1, 1); };
  EXPECT_GT(evidence(none, none), evidence(none, std::nullopt));
  EXPECT_GT(evidence(none, std::nullopt), evidence(some, std::nullopt));
  EXPECT_LT(evidence(people, people), 0);
  EXPECT_GT(evidence(people, people), -0.45);
  EXPECT_LT(evidence(wall, none), -1.5);
  EXPECT_LT(evidence(FreeSpaceViolation{10, 0}, std::nullopt), 0.2 * evidence(none, std::nullopt));
}

TEST(FreeSpace, WhatEveryProposalHasIsWorthNothing) {
  const Points scan = two_rooms().seen_from(left_eye, Random(1));
  const Cloud room({scan, left_eye});
  PairSpace furnished(room.features, room.features), corridor(room.features, room.features);
  const FreeSpace empty{FreeSpaceViolation{1000, 0}, FreeSpaceViolation{1000, 0}},
      filled{FreeSpaceViolation{1000, 200}, FreeSpaceViolation{1000, 200}};
  for (int i = 0; i < 48; ++i) {
    furnished.note_proposal(filled);
    corridor.note_proposal(empty);
  }
  EXPECT_GT(furnished.evidence(empty, 1), 1.5);
  EXPECT_LT(corridor.evidence(empty, 1), 0);
  const PairSpace unsearched(room.features, room.features);
  EXPECT_EQ(unsearched.evidence(empty, 1), free_space_evidence(empty, usual_rarity, 1));
  EXPECT_LT(unsearched.evidence(filled, 1), -1.5);
  EXPECT_EQ(furnished.evidence(filled, 1), corridor.evidence(filled, 1));
  EXPECT_LT(furnished.evidence(empty, 0), 0);  // nothing else speaks for the pose
}

TEST(FreeSpace, BeyondTheRimOfWhatWasSeenNothingIsKnown) {
  const Points wall = Boxes{{box(2, -1, -1, 2.1, 1, 1)}}.seen_from(Vector3d::Zero(), Random(1));
  const RangeImage image(wall, Vector3d::Zero(), voxel_size);
  EXPECT_EQ(image.look_at({1, 0, 0}).sight, RangeImage::Sight::empty);
  EXPECT_EQ(image.look_at({1, 0.3, -0.3}).sight, RangeImage::Sight::empty);
  EXPECT_EQ(image.look_at({1.9, 0, 0}).sight, RangeImage::Sight::possible);  // thinner than the tolerance
  EXPECT_EQ(image.look_at({3, 0, 0}).sight, RangeImage::Sight::possible);    // hidden
  EXPECT_EQ(image.look_at({1, 0.53, 0}).sight, RangeImage::Sight::out_of_view);
  EXPECT_EQ(image.look_at({-1, 0, 0}).sight, RangeImage::Sight::out_of_view);
  EXPECT_EQ(image.look_at({0, 0, 0}).sight, RangeImage::Sight::out_of_view);
}

// Squares of the cloud's places are 0, those of the viewpoint infinite.
TEST(FreeSpace, ACloudAlmostWithoutExtentSeenFromVeryFarAwayIsOneSpot) {
  Points spot;
  for (int i = 0; i < 20; ++i) spot.push_back(1e-170 * Vector3d(i, i % 3, i % 5));
  const RangeImage image(spot, Vector3d(1e200, 2e200, 0), voxel_size);
  EXPECT_EQ(image.look_at({0, 0, 0}).sight, RangeImage::Sight::possible);
}

TEST(FreeSpace, IsAskedAtTheFinestVoxelsOnEveryRung) {
  const Points left = two_rooms().seen_from(left_eye, Random(1)), right = two_rooms().seen_from(right_eye, Random(2));
  const Cloud a({left, left_eye}), b({right, right_eye});
  const Options options = Cloud::options();
  const ProgressCallback silent;
  StageClock clock(silent);
  ScaleLadder scales(
      a.features, b.features, [](StageClock&) {}, options, clock);
  ASSERT_GT(scales.rungs(), 1u);
  Transformation local = shift(6, 0, 0);
  local.translation() += a.features.origin - b.features.origin;
  const FreeSpace at_v = PairSpace(a.features, b.features).at(local);
  for (std::size_t rung = 0; rung < scales.rungs(); ++rung) {
    const FreeSpace asked = assess_pose(scales, rung, local, 1).free_space;
    EXPECT_EQ(asked.source->contradicting, at_v.source->contradicting);
    EXPECT_EQ(asked.target->in_view, at_v.target->in_view);
  }
}

TEST(FreeSpace, ConfirmsWhatTouchesAndNotWhatCrosses) {
  const Points left = two_rooms().seen_from(left_eye, Random(1)), again = two_rooms().seen_from(left_eye, Random(3));
  const Cloud a({left, left_eye}), b({again, left_eye});
  const ProgressCallback silent;
  const Options options = Cloud::options();
  StageClock clock(silent);
  ScaleLadder scales(
      a.features, b.features, [](StageClock&) {}, options, clock);
  const auto assess = [&](double yaw) {
    Transformation local(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
    const Vector3d about = left_eye;
    local.translation() = local.linear() * (a.features.origin - about) + about - b.features.origin;
    return assess_pose(scales, 0, local, 1);
  };
  const PoseAssessment right = assess(0), crossing = assess(0.1);
  EXPECT_NEAR(right.free_space_evidence, free_space_evidence(right.free_space, usual_rarity, 1), 0.01);
  EXPECT_GT(right.free_space_evidence, 0.5);
  EXPECT_LT(crossing.free_space.violation(), 0.03);
  EXPECT_NEAR(crossing.free_space_evidence, free_space_evidence(crossing.free_space, usual_rarity, 0), 0.01);
}

// Beside a pole that was seen, before a wall of which every so often one line was: nobody looked so closely there.
TEST(FreeSpace, BetweenScanLinesWhatLiesBesideASurfaceIsForgivenFromFartherOff) {
  Points seen;
  for (double z = -1.2; z < 1.3; z += 0.3)
    for (double y = -1; y < 1; y += 0.01) seen.push_back({2, y, z});
  for (double z = -0.8; z < 0.8; z += 0.01) seen.push_back({1, 0.4, z});
  Points beside;
  for (double y = -0.05; y < 0.05; y += 0.01)
    for (double z = 0.06; z < 0.09; z += 0.01) beside.push_back({1, y, z});
  const FreeSpace f = violations(beside, {seen, Vector3d::Zero()});
  EXPECT_GT(f.source->in_view, 0u);
  EXPECT_EQ(f.source->contradicting, 0u);
  const FreeSpace alone = violations(beside, {Points(seen.begin(), seen.begin() + 1800), Vector3d::Zero()});
  EXPECT_EQ(alone.source->contradicting, alone.source->in_view);  // without the pole
}

// Lines of a scanner that lie farther apart than the aperture is wide.
TEST(RangeImage, BetweenTwoScanLinesTheApertureGrows) {
  Points wall;
  for (double z = -1.2; z < 1.3; z += 0.3)
    for (double y = -1; y < 1; y += 0.01) wall.push_back({2, y, z});
  const RangeImage image(wall, Vector3d::Zero(), voxel_size);
  const RangeImage::Look between = image.look_at({1, 0, 0.075});
  EXPECT_EQ(between.sight, RangeImage::Sight::empty);
  EXPECT_GT(between.growth, 1);
  EXPECT_EQ(image.look_at({1.5, 0, 0.11}).sight, RangeImage::Sight::possible);  // with it grows what is tolerated
}

TEST(RangeImage, GroundBetweenTwoScanLinesIsNotEmpty) {
  Points ground;
  constexpr double height = 1.5, degree = std::numbers::pi / 180;
  for (double below = 2.62; below < 30; below += 2)
    for (double yaw = 0; yaw < 360; yaw += 0.1) {
      const double r = height / std::tan(below * degree);
      ground.push_back({r * std::cos(yaw * degree), r * std::sin(yaw * degree), -height});
    }
  const RangeImage image(ground, Vector3d::Zero(), voxel_size);
  for (double below = 5; below < 25; below += 0.1)
    EXPECT_NE(image.look_at({height / std::tan(below * degree), 0, -height}).sight, RangeImage::Sight::empty) << below;
}

TEST(RangeImage, IsTheSameWhereverItIsTurned) {
  Random random(3);
  const Points scan = two_rooms().seen_from(left_eye, Random(1));
  const RangeImage image(scan, left_eye, voxel_size);
  const Transformation g = random.motion(1);
  const RangeImage turned(testing::moved(g, scan), g * left_eye, voxel_size);
  int different = 0, empty = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d point = random.in_cube(6);
    different += image.look_at(point).sight != turned.look_at(g * point).sight;
    empty += image.look_at(point).sight == RangeImage::Sight::empty;
  }
  EXPECT_LE(different, 4);  // rounding
  EXPECT_GT(empty, 500);
}

TEST(RangeImage, AFarViewpointMeansParallelLinesOfSight) {
  Random random(4);
  const testing::BumpySurface surface(random);
  const Points scan = surface.sample(random, 40000, 3);
  const auto seen_from = [&](double height) { return RangeImage(scan, {0, 0, height}, voxel_size); };
  const RangeImage far = seen_from(1e4), farther = seen_from(1e9), farthest = seen_from(1e300);
  int different = 0;
  for (int i = 0; i < 5000; ++i) {
    const double x = random.uniform(-2.8, 2.8), y = random.uniform(-2.8, 2.8);
    const Vector3d above(x, y, surface.height_at(x, y) + 1.5), below(x, y, surface.height_at(x, y) - 1.5);
    different += far.look_at(above).sight != RangeImage::Sight::empty;
    EXPECT_EQ(far.look_at(below).sight, RangeImage::Sight::possible);
    different += far.look_at(above).sight != farther.look_at(above).sight;
    different += farther.look_at(above).sight != farthest.look_at(above).sight;
  }
  EXPECT_LT(different, 100);  // steep slopes within the aperture
}

TEST(RangeImage, DegenerateCloudsSeeNothing) {
  const Points none, one{Vector3d(1, 0, 0)}, line{Vector3d(1, 0, 0), Vector3d(2, 0, 0), Vector3d(3, 0, 0)};
  EXPECT_EQ(RangeImage(none, Vector3d::Zero(), 1).look_at({0.5, 0, 0}).sight, RangeImage::Sight::out_of_view);
  EXPECT_EQ(RangeImage(one, Vector3d::Zero(), 1).look_at({0.5, 0, 0}).sight, RangeImage::Sight::out_of_view);
  EXPECT_EQ(RangeImage(one, one[0], 1).look_at({0.5, 0, 0}).sight, RangeImage::Sight::out_of_view);
  EXPECT_EQ(RangeImage(line, Vector3d::Zero(), 0.1).look_at({0.1, 0, 0}).sight, RangeImage::Sight::empty);
}

}  // namespace
}  // namespace igsp
