#include <gtest/gtest.h>

#include <string>

#include "io/io_testing.hpp"

namespace igsp::io {
namespace {

using testing::expect_unreadable;
using testing::read_content;

const Points two_points = {{1, 2, 3}, {-4, 5.5, 6}};

TEST(TextReader, EverySeparator) {
  for (const auto content : {"1 2 3\n-4 5.5 6\n", "1\t2\t3\n-4\t5.5\t6\n", "1,2,3\n-4,5.5,6\n", "1;2;3\n-4;5.5;6\n",
                             "  1   2 \t 3  \n-4 5.5 6", "1, 2, 3\n-4 ,5.5 ,6\n", "1 2 3\n-4;5.5;6\n",
                             "+1 2. 3e0\n-4.0 +5.5 .6E1\n", "1,2,3,\n-4,5.5,6,\n"}) {
    for (const auto name : {"a.xyz", "a.txt", "a.csv", "a.pts", "A.XYZ"}) {
      const LoadedCloud cloud = read_content(name, content);
      EXPECT_EQ(cloud.points, two_points) << content;
      EXPECT_EQ(cloud.format, FileFormat::text);
    }
  }
}

TEST(TextReader, CommentsBlankLinesWindowsLineEndsAndByteOrderMark) {
  EXPECT_EQ(read_content("a.xyz", "\xEF\xBB\xBF# x y z\r\n\r\n//X Y Z\r\n1 2 3\r\n  # a comment\r\n \t\r\n-4 5.5 6\r\n")
                .points,
            two_points);
}

TEST(TextReader, ExtraColumnsAreIgnored) {
  EXPECT_EQ(read_content("a.pts", "1 2 3 -1200 255 0 0\n-4 5.5 6 label 0x7 ?\n").points, two_points);
  EXPECT_EQ(read_content("a.csv", "1,2,3,,\n-4,5.5,6,\"a name\",7\n").points, two_points);
}

TEST(TextReader, ALineOfColumnNames) {
  EXPECT_EQ(read_content("a.csv", "x,y,z\n1,2,3\n-4,5.5,6\n").points, two_points);
  EXPECT_EQ(read_content("a.csv", "\"X\";\"Y\";\"Z\"\r\n1;2;3\r\n-4;5.5;6\r\n").points, two_points);
  EXPECT_EQ(read_content("a.csv", "label,z,intensity,x,y,time\na,3,,1,2\nb,6,7,-4,5.5,8\n").points, two_points);
  EXPECT_EQ(read_content("a.txt", "# a scan\nX Y Z R G B\n1 2 3 0 0 0\n-4 5.5 6 0 0 0\n").points, two_points);
  expect_unreadable("a.csv", "easting,northing,height\n1,2,3\n", {"line 1", "'x'", "'easting'"});
  expect_unreadable("a.csv", "x,y,x,z\n1,2,3,4\n", {"line 1", "'x'", "found 2"});
  expect_unreadable("a.csv", "x,y,z\nx,y,z\n1,2,3\n", {"line 2", "'x'"});
  expect_unreadable("a.csv", "label,z,intensity,x,y\na,3,,1\n", {"line 2", "too few"});
}

TEST(TextReader, TheCountOfPts) {
  const testing::TemporaryFolder folder;
  PointReader reader(folder.write("a.pts", "2\n1 2 3 0\n-4 5.5 6 0\n\n"));
  EXPECT_EQ(reader.declared_points(), 2u);
  EXPECT_EQ(reader.next_chunk().size(), 2u);
  EXPECT_TRUE(reader.next_chunk().empty());
  EXPECT_TRUE(read_content("a.pts", "0\n").points.empty());
  expect_unreadable("a.pts", "3\n1 2 3 0 0 0\n-4 5.5 6 0 0 0\n", {"line 3", "1 points too early", "truncated"});
  expect_unreadable("a.pts", "1\n1 2 3\n-4 5.5 6\n", {"line 3", "more points"});
  expect_unreadable("a.pts", "10000000000000000000\n1 2 3\n-4 5.5 6\n", {"byte offset 21", "10000000000000000000"});
}

TEST(TextReader, WithoutACountNoneIsDeclared) {
  const testing::TemporaryFolder folder;
  EXPECT_EQ(PointReader(folder.write("a.xyz", "1 2 3\n")).declared_points(), 0u);
}

TEST(TextReader, NonFinitePointsAreDroppedAndCounted) {
  const LoadedCloud cloud = read_content("a.xyz", "nan nan nan\n1 2 3\n0 inf 0\n-4 5.5 6\n0 0 -Infinity\n");
  EXPECT_EQ(cloud.points, two_points);
  EXPECT_EQ(cloud.dropped, 3u);
}

TEST(TextReader, OnlyCommentsAreZeroPoints) {
  EXPECT_TRUE(read_content("a.xyz", "# nothing\n\n").points.empty());
}

TEST(TextReader, BadLinesNameTheLine) {
  expect_unreadable("a.xyz", "1 2 3\n# fine\n4 5\n", {"line 3", "too few"});
  expect_unreadable("a.xyz", "1 2 3\n4 5 six\n", {"line 2", "'six' is not a number"});
  expect_unreadable("a.xyz", "1 2 3\n4 5 6,\n", {"line 2", "is not a number"});
  expect_unreadable("a.csv", "1,2,3\n4,,6\n", {"line 2", "''"});
  expect_unreadable("a.xyz", "1 2 3\n4 5 0x10\n", {"line 2", "'0x10'"});
  expect_unreadable("a.xyz", "1 2 3\n4 5 --6\n", {"line 2", "'--6'"});
  expect_unreadable("a.xyz", "1 2 3\n4 5 +-6\n", {"line 2", "'+-6'"});
  expect_unreadable("a.xyz", std::string("\x01\x02\0\x80", 4), {"line 1", "'??"});
  expect_unreadable("a.xyz", "1 2 3\n" + std::string(std::size_t{3} << 20, '7'), {"line 2", "longer than"});
}

/// A decimal comma must never silently become a separator.
TEST(TextReader, DecimalCommasAreAnError) {
  expect_unreadable("a.csv", "1,5;2,5;3,5\n", {"line 1", "'1,5' is not a number"});
  expect_unreadable("a.txt", "1,5 2,5 3,5\n", {"line 1", "'5 2' is not a number"});
  expect_unreadable("a.txt", "1,5\t2,5\t3,5\n", {"line 1", "is not a number"});
}

}  // namespace
}  // namespace igsp::io
