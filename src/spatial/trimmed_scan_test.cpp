#include "spatial/trimmed_scan.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/core_testing.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

using Eigen::Vector3d;

Points cube_of(std::size_t count, std::uint64_t seed = 1) {
  testing::Random random(seed);
  Points points(count);
  for (Vector3d& point : points) point = random.in_cube(1);
  return points;
}

Scan with_parts(const Points& points, std::vector<ScanPart> parts) {
  Scan scan(points);
  scan.parts = std::move(parts);
  return scan;
}

const Vector3d here(1, 2, 3), there(-4, 5, 6);

TEST(TrimmedScan, ASingleScanIsOnePart) {
  const Points points = cube_of(100);
  const TrimmedScan scan({points, here}, "cloud");
  ASSERT_EQ(scan.parts.size(), 1u);
  EXPECT_EQ(scan.parts[0].points, 100u);
  EXPECT_EQ(scan.parts[0].viewpoint, here);
}

TEST(TrimmedScan, WhereNothingIsKnownThereAreNoParts) {
  const Points points = cube_of(100);
  EXPECT_TRUE(TrimmedScan(points, "cloud").parts.empty());
  EXPECT_TRUE(TrimmedScan(with_parts(points, {{40, {}}, {60, {}}}), "cloud").parts.empty());
}

TEST(TrimmedScan, StrayPointsAreOfNoPart) {
  Points points = cube_of(400);
  points[10] = points[11] = points[399] = Vector3d(1000, 0, 0);
  const TrimmedScan scan(with_parts(points, {{150, here}, {0, there}, {249, {}}, {1, there}}), "cloud");
  EXPECT_EQ(scan.cloud.stray().count, 3u);
  ASSERT_EQ(scan.parts.size(), 2u);
  EXPECT_EQ(scan.parts[0].points, 148u);
  EXPECT_EQ(scan.parts[0].viewpoint, here);
  EXPECT_EQ(scan.parts[1].points, 249u);
  EXPECT_FALSE(scan.parts[1].viewpoint);
  EXPECT_TRUE(TrimmedScan(with_parts(points, {{399, {}}, {1, there}}), "cloud").parts.empty());
}

TEST(TrimmedScan, ViewpointsComeIntoTheUnit) {
  const Points points = cube_of(100);
  const TrimmedScan scan = TrimmedScan(with_parts(points, {{40, here}, {60, there}}), "cloud").in_unit(0.25);
  EXPECT_EQ(scan.parts[0].viewpoint, 4 * here);
  EXPECT_EQ(scan.parts[1].viewpoint, 4 * there);
  EXPECT_EQ(scan.cloud.points()[70], 4 * points[70]);
}

TEST(TrimmedScan, PartsThatAreNotTheCloudsAreNamed) {
  const Points points = cube_of(100);
  const auto reason = [&](const Scan& scan) -> std::string {
    try {
      TrimmedScan(scan, "source");
    } catch (const InvalidArgument& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(reason(with_parts(points, {{40, here}, {60, there}})), "none");
  EXPECT_EQ(reason(with_parts(points, {{40, here}, {59, there}})),
            "the parts of source have fewer points than it: each of its 100 points is of one part");
  const std::string more = "the parts of source have more points than it: each of its 100 points is of one part";
  EXPECT_EQ(reason(with_parts(points, {{40, here}, {61, there}})), more);
  EXPECT_EQ(reason(with_parts(points, {{101, here}, {std::numeric_limits<std::size_t>::max(), there}})), more);
  EXPECT_NE(reason(with_parts(points, {{40, here}, {60, Vector3d(0, NAN, 0)}})).find("is not finite"),
            std::string::npos);
  Scan both = with_parts(points, {{40, here}, {60, there}});
  both.viewpoint = here;
  EXPECT_EQ(reason(both), "source has parts and a viewpoint; each of its parts has its own");
}

}  // namespace
}  // namespace igsp
