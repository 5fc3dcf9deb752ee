#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

#include "io/io_testing.hpp"
#include "io/whole_file.hpp"

namespace igsp {
namespace {

using io::testing::expect_file_error;
using io::testing::TemporaryFolder;

Transformation read_content(const std::string& content) {
  const TemporaryFolder folder;
  return read_transformation(folder.write("T.txt", content));
}

void expect_unreadable(const std::string& content, std::initializer_list<std::string> parts) {
  const TemporaryFolder folder;
  const auto path = folder.write("T.txt", content);
  expect_file_error([&] { read_transformation(path); }, {path.string(), "line"});
  expect_file_error([&] { read_transformation(path); }, parts);
}

Transformation quarter_turn() {
  Transformation expected = Transformation::Identity();
  expected.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  expected.translation() << 10, -20, 0.5;
  return expected;
}

TEST(TransformationFile, ReadsWhatItWroteBitByBit) {
  const TemporaryFolder folder;
  EXPECT_TRUE(rc::check([&] {
    const auto number = [] { return *rc::gen::inRange(-1000000, 1000000) / 7.0; };
    Transformation transformation = Transformation::Identity();
    transformation.linear() = Eigen::Quaterniond(number(), number(), number(), 1.0).normalized().toRotationMatrix();
    transformation.translation() = 100 * Eigen::Vector3d(number(), number(), number());
    std::filesystem::remove(folder / "T.txt");  // some file systems wait for the disk when a file is replaced
    write_transformation(folder / "T.txt", transformation);
    RC_ASSERT(read_transformation(folder / "T.txt").matrix() == transformation.matrix());
  }));
  EXPECT_EQ(folder.files(), 1u);
}

TEST(TransformationFile, RowsInAnyLayout) {
  for (const auto content : {"0 -1 0 10\n1 0 0 -20\n0 0 1 0.5\n0 0 0 1\n", "0 -1 0 10 1 0 0 -20 0 0 1 0.5 0 0 0 1",
                             "0 -1 0 10\n1 0 0 -20\n0 0 1 0.5\n", "# 3x4\n0,-1,0,10,\n1,0,0,-20,\n0,0,1,0.5\n",
                             "0\n-1\n0\n10\n1\n0\n0\n-20\n0\n0\n1\n0.5\n",
                             "// T\r\n0;-1;0;10\r\n\r\n1\t0\t0\t-20\r\n 0 0 1e0 +.5 \r\n0 0 0 1"}) {
    EXPECT_EQ(read_content(content).matrix(), quarter_turn().matrix()) << content;
  }
}

TEST(TransformationFile, RoundedMatricesAreTakenAsTheyAre) {
  EXPECT_EQ(read_content("0.8 -0.6 0 0\n0.6 0.8001 0 0\n0 0 1 0\n0 0 0 1\n")(1, 1), 0.8001);
}

TEST(TransformationFile, AFactorOfScaleIsWrittenAndNamedWhenItIsRead) {
  const TemporaryFolder folder;
  write_transformation(folder / "T.txt", quarter_turn(), 0.5);
  EXPECT_EQ(io::read_whole(folder / "T.txt", 1000), "0 -0.5 0 10\n0.5 0 0 -20\n0 0 0.5 0.5\n0 0 0 1\n");
  expect_file_error([&] { read_transformation(folder / "T.txt"); }, {"not a rigid motion", "multiplies by 0.5"});
}

TEST(TransformationFile, WhatIsNoRigidMotionIsRefused) {
  expect_unreadable("2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n", {"not a rigid motion"});
  expect_unreadable("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n", {"reflection"});
  expect_unreadable("1 0.1 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", {"not a rigid motion"});
  expect_unreadable("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 1 1\n", {"last row"});
  expect_unreadable("0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n", {"last row"});
}

TEST(TransformationFile, BadTextNamesTheLine) {
  expect_unreadable("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0\n", {"line 4", "15 numbers"});
  expect_unreadable("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1 5\n", {"line 4", "more than the 16"});
  expect_unreadable("1 0 0 0\n0 one 0 0\n", {"line 2", "'one'"});
  expect_unreadable("1 0 0 0\n0 1 0 nan\n", {"line 2", "'nan'"});
  expect_unreadable("1 0 0 0\n0 1 0 inf\n", {"line 2", "'inf'"});
  const TemporaryFolder folder;
  expect_file_error([&] { read_transformation(folder / "none.txt"); }, {"none.txt", "no such file"});
  expect_file_error([&] { read_transformation(folder.path()); }, {"directory"});
  expect_file_error([&] { read_transformation(folder.write("empty.txt", "")); }, {"empty.txt", "empty"});
}

TEST(TransformationFile, OnlyRigidMotionsAreWritten) {
  const TemporaryFolder folder;
  Transformation scaled = Transformation::Identity();
  scaled.linear() *= 2;
  EXPECT_THROW(write_transformation(folder / "T.txt", scaled), InvalidArgument);
  expect_file_error([&] { write_transformation(folder / "none/T.txt", Transformation::Identity()); }, {"none/T.txt"});
  EXPECT_EQ(folder.files(), 0u);
}

}  // namespace
}  // namespace igsp
