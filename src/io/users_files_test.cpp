// Files as users have them. They lie outside the project; where they are not, this is skipped, visibly.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/io_testing.hpp"

namespace igsp::io {
namespace {

namespace fs = std::filesystem;

const fs::path users = IGSP_USERS_FILES;

/// Those that are refused, and words of the line that says why and what to do. All others give exactly the points.
const std::map<std::string, std::vector<std::string>> refused = {
    {"last_line_cut.xyz", {"cut short"}},
    {"mesh.obj", {"mesh", ".ply"}},
    {"off.off", {"mesh", ".ply"}},
    {"vtk_legacy.vtk", {".ply"}},
    {"pts_count_too_big.pts", {"count"}},
    {"pts_count_too_small.pts", {"count"}},
    {"comma_ascii.ply", {"replace the commas"}},
    {"comma_ascii.pcd", {"replace the commas"}},
    {"count_too_big_ascii.ply", {"count"}},
    {"two_scans.ply", {"a file of its own"}},
    {"binary_cut.pcd", {"bytes follow"}},
    {"size_short.pcd", {"write one for each"}},
    {"v3_extended.pcd", {"not supported"}},
    {"width_times_height_differs.pcd", {"correct the wrong one"}}};

/// Every point is one of the truth, in its order: the file holds all of them or those that are finite.
void expect_truth(const LoadedCloud& cloud, const Points& truth, double unit) {
  EXPECT_EQ(cloud.points.size() + cloud.dropped, truth.size());
  std::size_t next = 0;
  for (const Eigen::Vector3d& point : cloud.points) {
    while (next < truth.size() && (point * unit - truth[next]).norm() > 2e-6) ++next;
    ASSERT_LT(next, truth.size()) << point.transpose();
    ++next;
  }
}

TEST(UsersFiles, ExactlyThePointsOrALineThatHelps) {
  if (!fs::exists(users)) GTEST_SKIP() << users << " is not there";
  const Points truth = read_points(users / "truth_300_points.xyz").points;
  for (const auto folder : {"text", "pcd", "ply"}) {
    for (const auto& entry : fs::directory_iterator(users / folder)) {
      const std::string name = entry.path().filename();
      SCOPED_TRACE(name);
      if (const auto found = refused.find(name); found != refused.end()) {
        for (const std::string& part : found->second) {
          testing::expect_file_error([&] { read_points(entry.path()); }, {part});
        }
        continue;
      }
      if (name == "rgb3.ply") continue;  // three points of its own
      const bool millimetres = name == "int16_xyz_mm.pcd" || name == "short_xyz_scale.ply";
      EXPECT_NO_THROW(expect_truth(read_points(entry.path()), truth, millimetres ? 1e-3 : 1.0));
    }
  }
}

}  // namespace
}  // namespace igsp::io
