#include "io/pose_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "io/io_testing.hpp"

namespace igsp::io {
namespace {

using testing::expect_file_error;
using testing::TemporaryFolder;

TEST(PoseFile, TheContentDecides) {
  const TemporaryFolder folder;
  const std::string tum = "# time x y z qx qy qz qw\n1.5 1 2 3 0 0 0 1\n2.5 4 5 6 0 0 1 0\n3.5 0 0 0 0 0 0 1\n";
  const auto poses = read_poses(folder.write("a.txt", tum));
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[1].time, 2.5);
  EXPECT_EQ(poses[1].pose.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE(poses[1].pose.linear().isApprox(Eigen::Vector3d(-1, -1, 1).asDiagonal().toDenseMatrix()));
  const std::string row = "1 0 0 7 0 1 0 8 0 0 1 9\n";
  EXPECT_EQ(read_poses(folder.write("b.txt", row)).size(), 1u);
  EXPECT_EQ(read_poses(folder.write("c.txt", row + row))[1].time, 1);
  EXPECT_EQ(read_poses(folder.write("d.txt", "1 0 0 7 0 1 0 8\n0 0 1 9 0 0 0 1\n")).size(), 1u);
  EXPECT_EQ(read_poses(folder.write("d.tum", "1 0 0 7 0 1 0 0\n2 0 1 9 0 0 0 1\n")).size(), 2u);
}

TEST(PoseFile, ReadsBackAsItWasWritten) {
  const TemporaryFolder folder;
  std::vector<TimedPose> poses(3);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].time = static_cast<double>(i);
    poses[i].pose.translation() = Eigen::Vector3d(0.1, 1e6, -1.0 / 3) * static_cast<double>(i + 1);
    poses[i].pose.rotate(Eigen::AngleAxisd(0.4 * static_cast<double>(i), Eigen::Vector3d(1, 2, 3).normalized()));
  }
  for (const char* name : {"a.tum", "a.kitti"}) {
    write_poses(folder / name, poses);
    const auto read = read_poses(folder / name);
    ASSERT_EQ(read.size(), poses.size()) << name;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_EQ(read[i].time, poses[i].time) << name;
      EXPECT_EQ(read[i].pose.translation(), poses[i].pose.translation()) << name;
      EXPECT_TRUE(read[i].pose.linear().isApprox(poses[i].pose.linear(), 1e-14)) << name;
    }
  }
  EXPECT_THROW(write_poses(folder / "a.txt", poses), InvalidArgument);
  write_poses(folder / "one.txt", {poses[1]});
  EXPECT_EQ(read_poses(folder / "one.txt")[0].pose.matrix(), poses[1].pose.matrix());
}

TEST(PoseFile, WhatIsNoPoseIsNamed) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& content, const char* why) {
    expect_file_error([&] { read_poses(folder.write("a.txt", content)); }, {"a.txt", why});
  };
  refused("", "the file is empty");
  refused("1 2 3\n", "3 numbers");
  refused("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 3\n", "line 3: a quaternion of length 3");
  refused("1 0 0 7 0 1 0 8 0 0 1 9\n2 0 0 7 0 2 0 8 0 0 2 9\n", "line 2: not a rigid motion");
  refused("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 x\n", "line 2");
}

}  // namespace
}  // namespace igsp::io
