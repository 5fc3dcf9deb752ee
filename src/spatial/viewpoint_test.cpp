#include "igsp/viewpoint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/core_testing.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

using Eigen::Vector3d;
using testing::Random;

/// A room of 8 m x 6 m x 3 m about the origin with a pillar, as a scanner in it sees it.
Points room_seen_from(const Vector3d& eye, std::size_t count, std::uint64_t seed = 1) {
  Random random(seed);
  const Eigen::AlignedBox3d room(Vector3d(-4, -3, -1.5), Vector3d(4, 3, 1.5)),
      pillar(Vector3d(1, 0.5, -1.5), Vector3d(1.6, 1.1, 1.5));
  Points points;
  while (points.size() < count) {
    const Vector3d direction = random.direction();
    const Eigen::Array3d wall =
        ((direction.array() > 0).select(room.max(), room.min()) - eye).array() / direction.array();
    const Eigen::Array3d low = (pillar.min() - eye).array() / direction.array(),
                         high = (pillar.max() - eye).array() / direction.array();
    const double enter = low.min(high).maxCoeff(), leave = low.max(high).minCoeff();
    points.push_back(eye + direction * (enter > 0 && enter < leave ? enter : wall.minCoeff()));
  }
  return points;
}
const Vector3d eye(-1, -0.5, 0.2);

TEST(HiddenPoints, NoneFromWhereTheScannerStood) {
  const HiddenPoints found = hidden_points(room_seen_from(eye, 50000), eye, 90);
  EXPECT_LT(found.share, 0.01);
  EXPECT_LT(hidden_points(room_seen_from(eye, 5000), eye).share, 0.1);
  EXPECT_GT(found.compared, 0.5);
}

TEST(HiddenPoints, MostFromOutsideTheRoom) {
  const Points room = room_seen_from(eye, 50000);
  EXPECT_GT(hidden_points(room, {-4.5, 0.3, 0}).share, 0.5);  // behind a wall
  EXPECT_GT(hidden_points(room, {0, 0, 50}).share, 0.3);      // above the ceiling, which hides the floor
}

TEST(HiddenPoints, DoNotDependOnTheOrderOfThePoints) {
  Points room = room_seen_from(eye, 20000);
  const HiddenPoints before = hidden_points(room, {2, 1, 0});
  std::ranges::reverse(room);
  EXPECT_EQ(hidden_points(room, {2, 1, 0}).share, before.share);
  EXPECT_EQ(hidden_points(room, {2, 1, 0}).compared, before.compared);
}

TEST(HiddenPoints, AFarViewpointMeansParallelLinesOfSight) {
  Random random(2);
  const testing::BumpySurface surface(random);
  const Points scan = surface.sample(random, 40000, 3);
  for (const double far : {30.0, 1e4, 1e9, 1e300}) {
    EXPECT_LT(hidden_points(scan, {0, 0, far}).share, 0.1) << far;
    EXPECT_GT(hidden_points(scan, {0, 0, far}).compared, 0.5) << far;
  }
}

TEST(HiddenPoints, DegenerateCloudsHideNothing) {
  const Vector3d nan(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  EXPECT_EQ(hidden_points(Points{Vector3d(1, 2, 3)}, Vector3d::Zero()).share, 0);
  EXPECT_EQ(hidden_points(Points(100, Vector3d(1, 2, 3)), Vector3d(1, 2, 3)).share, 0);
  EXPECT_EQ(hidden_points(Points{Vector3d(1, 0, 0), Vector3d(2, 0, 0)}, Vector3d::Zero()).share, 0.5);
  EXPECT_THROW(hidden_points(Points{}, Vector3d::Zero()), InvalidArgument);
  EXPECT_THROW(hidden_points(Points{Vector3d::Zero()}, nan), InvalidArgument);
  EXPECT_THROW(hidden_points(Points{nan}, Vector3d::Zero()), InvalidArgument);
  for (const int cells : {0, -1, 1001}) {
    EXPECT_THROW(hidden_points(Points{{1, 0, 0}}, Vector3d::Zero(), cells), InvalidArgument) << cells;
  }
}

TEST(FindViewpoint, WhatIsGivenIsUsedUnlessTheCloudContradicts) {
  const Points room = room_seen_from(eye, 50000);
  const Vector3d behind_the_wall(-4.5, 0.3, 0);
  const auto given = [](const Vector3d& at, bool insist) {
    return ViewpointRequest{ViewpointRequest::Kind::given, at, insist};
  };
  const ViewpointFinding right = find_viewpoint(room, given(eye, false));
  EXPECT_EQ(right.viewpoint, eye);
  EXPECT_EQ(right.warning, "");
  const ViewpointFinding wrong = find_viewpoint(room, given(behind_the_wall, false));
  EXPECT_FALSE(wrong.viewpoint);
  EXPECT_NE(wrong.warning.find(" % of the points are hidden"), std::string::npos) << wrong.warning;
  const ViewpointFinding insisted = find_viewpoint(room, given(behind_the_wall, true));
  EXPECT_EQ(insisted.viewpoint, behind_the_wall);
  EXPECT_EQ(insisted.warning, "");
}

TEST(FindViewpoint, WhatTheFileSays) {
  const Points room = room_seen_from(eye, 50000);
  EXPECT_EQ(find_viewpoint(room, {}, eye).viewpoint, eye);
  EXPECT_FALSE(find_viewpoint(room, {}, Vector3d(-4.5, 0.3, 0)).viewpoint);
  EXPECT_FALSE(find_viewpoint(room, {}, Vector3d(NAN, 0, 0)).viewpoint);
  EXPECT_FALSE(find_viewpoint(room, {.kind = ViewpointRequest::Kind::none}, eye).viewpoint);
  EXPECT_FALSE(find_viewpoint(room, {}).viewpoint);
}

TEST(HiddenPoints, AStrayPointDoesNotSpoilIt) {
  const Points room = room_seen_from(eye, 20000);
  for (const double away : {50.0, 1e4, -1e7}) {
    Points with_stray = room;
    with_stray.push_back(Vector3d(away, 1, 2));
    for (const Vector3d& at : {eye, Vector3d(2, 1, 0), Vector3d(-4.5, 0.3, 0)}) {
      EXPECT_EQ(hidden_points(with_stray, at).share, hidden_points(room, at).share) << away;
    }
  }
}

const Vector3d corner(-3.5, -2.5, -1);  // of the room: near some walls and far from others

/// As a scanner at the origin of its own frame has it.
Points room_about_the_scanner(std::size_t count) {
  Points room = room_seen_from(corner, count);
  for (Vector3d& point : room) point -= corner;
  return room;
}

TEST(ViewpointAtOrigin, BelievedWhereTheCloudLooksLikeOneScanFromThere) {
  const ViewpointFinding found = find_viewpoint(room_about_the_scanner(60000), {});
  EXPECT_EQ(found.viewpoint, Vector3d::Zero()) << found.reason;
  EXPECT_NE(found.reason.find("though the file does not say it: from its origin "), std::string::npos) << found.reason;
  EXPECT_EQ(found.warning, "");
}

TEST(ViewpointAtOrigin, NeitherOrderNorStrayPointsNorCellsWithoutReturnMatter) {
  Points room = room_about_the_scanner(60000);
  const std::string reason = find_viewpoint(room, {}).reason;
  std::ranges::reverse(room);
  room.insert(room.begin(), Vector3d(3000, -9999, 1));
  EXPECT_EQ(find_viewpoint(room, {}).reason, reason);
  room.insert(room.begin(), 20000, Vector3d::Zero());
  EXPECT_EQ(find_viewpoint(room, {}).viewpoint, Vector3d::Zero());
}

TEST(ViewpointAtOrigin, UnknownInDoubt) {
  const auto reason_of = [](const Points& points) {
    const ViewpointFinding found = find_viewpoint(points, {});
    EXPECT_FALSE(found.viewpoint) << found.reason;
    return found.reason;
  };
  const auto expect_reason = [&](const Points& points, std::string_view why) {
    const std::string reason = reason_of(points);
    EXPECT_NE(reason.find(why), std::string::npos) << reason;
  };
  Points survey = room_about_the_scanner(60000);
  for (Vector3d& point : survey) point += Vector3d(500000, 5000000, 300);
  expect_reason(survey, "its origin lies outside of the cloud");
  expect_reason(room_seen_from(eye, 60000), "");  // a metre beside the scanner
  Points fused = room_about_the_scanner(60000);
  const Vector3d other(2.8, -1.5, 0.1);
  for (const Vector3d& point : room_seen_from(other, 60000, 2)) fused.push_back(point - corner);
  expect_reason(fused, "hidden");
  Random random(3);
  Points ball;
  for (int i = 0; i < 20000; ++i) ball.push_back(random.direction());
  expect_reason(ball, "about equally far");
  expect_reason(room_about_the_scanner(500), "too few");
  expect_reason(Points(100, Vector3d::Zero()), "outside");
}

// A room, and a tent in it that hides all of it from where the first scanner stood before.
TEST(FindViewpoints, EachScanIsAskedByItsOwnPoints) {
  const Vector3d other = eye + Vector3d(0.05, 0, 0);
  Points points = room_seen_from(eye, 30000);
  Random random(2);
  for (int i = 0; i < 20000; ++i) points.push_back(eye + 0.3 * random.direction());
  EXPECT_FALSE(find_viewpoint(points, {}, eye).viewpoint);
  const ViewpointFinding both = find_viewpoints(points, {}, {{30000, eye}, {20000, other}});
  EXPECT_FALSE(both.viewpoint);
  EXPECT_EQ(both.reason, "2 scans in one file, all of their viewpoints known");
  ASSERT_EQ(both.parts.size(), 2u);
  EXPECT_EQ(both.parts[0].viewpoint, eye);
  EXPECT_EQ(both.parts[1].points, 20000u);
  EXPECT_EQ(both.parts[1].viewpoint, other);
}

TEST(FindViewpoints, OneThatItsOwnPointsContradictIsLeftOut) {
  Points points = room_seen_from(eye, 30000);
  const Points second = room_seen_from(eye, 20000, 2);
  points.insert(points.end(), second.begin(), second.end());
  const ViewpointFinding found = find_viewpoints(points, {}, {{30000, eye}, {0, eye}, {20000, Vector3d(9, 7, 0)}});
  EXPECT_EQ(found.parts[0].viewpoint, eye);
  EXPECT_FALSE(found.parts[1].viewpoint);
  EXPECT_FALSE(found.parts[2].viewpoint);
  EXPECT_EQ(found.reason,
            "3 scans in one file, 1 of their viewpoints known, that of scan 1 is unknown: it has no points");
  const ViewpointFinding wrong = find_viewpoints(points, {}, {{30000, eye}, {20000, Vector3d(9, 7, 0)}});
  EXPECT_NE(wrong.reason.find("that of scan 1 is unknown: what the file says contradicts its points"),
            std::string::npos)
      << wrong.reason;
}

TEST(FindViewpoints, WhatIsSaidIsOfTheWholeCloud) {
  const Points points = room_seen_from(eye, 30000);
  const std::vector<ScanPart> halves = {{15000, eye}, {15000, eye}};
  const ViewpointFinding given = find_viewpoints(points, parse_viewpoint("--v", "0.1,0.2,0.3!"), halves);
  EXPECT_EQ(given.viewpoint, Vector3d(0.1, 0.2, 0.3));
  EXPECT_TRUE(given.parts.empty());
  EXPECT_TRUE(find_viewpoints(points, parse_viewpoint("--v", "none"), halves).parts.empty());
}

TEST(ParseViewpoint, EveryForm) {
  using Kind = ViewpointRequest::Kind;
  EXPECT_EQ(parse_viewpoint("--v", "auto").kind, Kind::automatic);
  EXPECT_EQ(parse_viewpoint("--v", "none").kind, Kind::none);
  const ViewpointRequest given = parse_viewpoint("--v", "-1.5,2e3,+0");
  EXPECT_EQ(given.kind, Kind::given);
  EXPECT_EQ(given.position, Vector3d(-1.5, 2000, 0));
  EXPECT_FALSE(given.insist);
  EXPECT_TRUE(parse_viewpoint("--v", "1, 2, 3!").insist);
}

TEST(ParseViewpoint, AnythingElseIsNamed) {
  for (const char* text : {"", "1,2", "1,2,3,4", "1,2,3,", "1,2,x", "1,2,nan", "1,2,inf", "1,2,1e999", "1 2 3", "auto!",
                           "None", "!", "1,,3", "1,2,3!!"}) {
    try {
      parse_viewpoint("--source-viewpoint", text);
      ADD_FAILURE() << text;
    } catch (const InvalidArgument& error) {
      EXPECT_NE(std::string(error.what()).find("--source-viewpoint is '"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace igsp
