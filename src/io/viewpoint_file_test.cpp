#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "io/io_testing.hpp"
#include "io/moved_copy.hpp"

namespace igsp::io {
namespace {

using Eigen::Vector3d;
using testing::read_bytes;
using testing::TemporaryFolder;

std::string ply_with(const std::string& comment) {
  return "ply\nformat ascii 1.0\n" + comment +
         "\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
}

std::string pcd_with(const std::string& line) {
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n" + line +
         "\nPOINTS 1\nDATA ascii\n1 2 3\n";
}

std::optional<Vector3d> viewpoint_of(const std::string& name, const std::string& content) {
  const TemporaryFolder folder;
  const LoadedCloud cloud = read_points(folder.write(name, content));
  EXPECT_EQ(cloud.points, Points{Vector3d(1, 2, 3)});
  return cloud.viewpoint;
}

TEST(ViewpointOfAFile, PlyComment) {
  EXPECT_EQ(viewpoint_of("a.ply", ply_with("comment viewpoint 0 -1.5 2e3")), Vector3d(0, -1.5, 2000));
  EXPECT_EQ(viewpoint_of("a.ply", ply_with("comment viewpoint 0 0 0")), Vector3d::Zero());
  for (const char* comment : {"comment viewpoint 0 0", "comment viewpoint 0 0 0 0", "comment viewpoint nan 0 0",
                              "comment viewpoint of the author", "comment", "comment the viewpoint 0 0 0"}) {
    EXPECT_FALSE(viewpoint_of("a.ply", ply_with(comment))) << comment;
  }
}

TEST(ViewpointOfAFile, PcdViewpointUnlessItIsTheDefault) {
  EXPECT_EQ(viewpoint_of("a.pcd", pcd_with("VIEWPOINT 1 -2.5 3 1 0 0 0")), Vector3d(1, -2.5, 3));
  EXPECT_EQ(viewpoint_of("a.pcd", pcd_with("VIEWPOINT 0 0 0 0 1 0 0")), Vector3d::Zero());  // turned: somebody set it
  for (const char* line : {"VIEWPOINT 0 0 0 1 0 0 0", "VIEWPOINT 0.0 -0 0 1.0 0 0 0", "VIEWPOINT 1 2 3",
                           "VIEWPOINT 1 2 x 1 0 0 0", "VIEWPOINT inf 2 3 1 0 0 0", "VIEWPOINT", "# nothing"}) {
    EXPECT_FALSE(viewpoint_of("a.pcd", pcd_with(line))) << line;
  }
}

TEST(ViewpointOfAFile, ReadsBackAsItWasWritten) {
  const TemporaryFolder folder;
  const Points points{Vector3d(1, 2, 3), Vector3d(4, 5, 6)};
  const Vector3d viewpoint(0.1, -1e7, 1.0 / 3);
  for (const char* name : {"a.ply", "a.pcd"}) {
    const std::filesystem::path path = folder / name;
    write_points(path, points, {.viewpoint = viewpoint});
    EXPECT_EQ(read_points(path).points, points) << name;
    EXPECT_EQ(read_points(path).viewpoint, viewpoint) << name;
    EXPECT_EQ(PointReader(path).viewpoint(), viewpoint) << name;
    write_points(path, points);
    EXPECT_FALSE(read_points(path).viewpoint) << name;
    EXPECT_THROW(write_points(path, points, {.viewpoint = Vector3d(0, NAN, 0)}), InvalidArgument) << name;
  }
  write_points(folder / "a.xyz", points, {.viewpoint = viewpoint});
  EXPECT_FALSE(read_points(folder / "a.xyz").viewpoint);
}

Transformation quarter_turn_and_shift() {
  Transformation motion = Transformation::Identity();
  motion.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  motion.translation() = Vector3d(10, 20, 30);
  return motion;
}

TEST(ViewpointOfAFile, MovesWithThePoints) {
  const TemporaryFolder folder;
  const Transformation motion = quarter_turn_and_shift();
  const auto source = folder.write("a.ply", ply_with("comment viewpoint 1 0 -0.5"));
  write_moved(source, folder / "b.ply", motion);
  EXPECT_EQ(read_points(folder / "b.ply").viewpoint, Vector3d(10, 21, 29.5));
  write_moved(source, folder / "c.ply", Transformation::Identity());
  EXPECT_EQ(read_bytes(folder / "c.ply"), read_bytes(source));
  write_moved(folder.write("a.pcd", pcd_with("VIEWPOINT 1 0 -0.5 1 0 0 0")), folder / "b.pcd", motion);
  EXPECT_EQ(read_points(folder / "b.pcd").viewpoint, Vector3d(10, 21, 29.5));
}

TEST(ViewpointOfAFile, TheDefaultOneOfAPcdMovesOnlyIfItIsKnownToBeTrue) {
  const TemporaryFolder folder;
  const Transformation motion = quarter_turn_and_shift();
  const auto source = folder.write("a.pcd", pcd_with("VIEWPOINT 0 0 0 1 0 0 0"));
  write_moved(source, folder / "b.pcd", motion);
  EXPECT_FALSE(read_points(folder / "b.pcd").viewpoint);
  EXPECT_NE(read_bytes(folder / "b.pcd").find("VIEWPOINT 0 0 0 1 0 0 0\n"), std::string::npos);
  write_moved(source, folder / "b.pcd", motion, {.viewpoint = Vector3d::Zero()});
  EXPECT_EQ(read_points(folder / "b.pcd").viewpoint, Vector3d(10, 20, 30));
}

TEST(ViewpointOfAFile, WhatIsKnownTakesThePlaceOfWhatItSays) {
  const TemporaryFolder folder;
  const Transformation motion = quarter_turn_and_shift();
  for (const auto& [name, content] : {std::pair("a.pcd", pcd_with("VIEWPOINT 1 0 -0.5 1 0 0 0")),
                                      std::pair("a.ply", ply_with("comment viewpoint 1 0 -0.5"))}) {
    const auto source = folder.write(name, content), moved = folder / (std::string("moved_") + name);
    write_moved(source, moved, motion, {.viewpoint = Vector3d(4, 5, 6)});
    EXPECT_EQ(read_points(moved).viewpoint, Vector3d(5, 24, 36)) << name;
  }
}

}  // namespace
}  // namespace igsp::io
