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
  EXPECT_EQ(read_content("a.csv", "x,y,z\nm,m,m\n1,2,3\n-4,5.5,6\n").points, two_points);
  expect_unreadable("a.csv", "x,y,x,z\n1,2,3,4\n", {"line 1", "2 columns named x", "--columns"});
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
TEST(TextReader, DecimalCommas) {
  for (const auto content : {"1,0;2,0;3\n-4;5,5;6\n", "1,0 2,0 3,0\n-4,0 5,5 6\n", "1,0\t2,0\t3,0\n-4,0\t5,5\t6,0\n",
                             "x;y;z\n1,0;2,0;3,0\n-4,0;5,5;6,0\n", "X\tY\tZ\n1,0\t2,0\t3,0\n-4,0\t5,5\t6,0\n",
                             "\"x\",\"y\",\"z\"\n\"1,0\",\"2,0\",\"3,0\"\n\"-4,0\",\"5,5\",\"6,0\"\n"}) {
    EXPECT_EQ(read_content("a.csv", content).points, two_points) << content;
  }
  expect_unreadable("a.csv", "x,y,z\n1,0,2,0,3,0\n-4,0,5,5,6,0\n", {"line 2", "6 values under 3 names", "';'"});
  expect_unreadable("a.txt", "1,0 2,0 3,0\n1.5 2,0 3,0\n1,0 2,0 3,0\n", {"line 1", "is not a number", "decimal mark"});
}

TEST(TextReader, NamesThatOtherProgramsWrite) {
  for (const auto names : {"Easting,Northing,Height", "easting,NORTHING,Elevation", "X [m],Y [m],Z [m]",
                           "X(m),Y(m),Z(m)", "E,N,H", "\"Points:0\",\"Points:1\",\"Points:2\"", "X,Y,Elevation"}) {
    EXPECT_EQ(read_content("a.csv", std::string(names) + "\n1,2,3\n-4,5.5,6\n").points, two_points) << names;
  }
  EXPECT_EQ(read_content("a.txt", "X [m]\tY [m]\tZ [m]\n1\t2\t3\n-4\t5.5\t6\n").points, two_points);
  EXPECT_EQ(read_content("a.txt", "//R X Y Z\n7 1 2 3\n7 -4 5.5 6\n").points, two_points);
  EXPECT_EQ(read_content("a.txt", "My scan\n1 2 3\n-4 5.5 6\n").points, two_points);
  expect_unreadable("a.csv", "Hoch,Rechts,Oben\n1,2,3\n",
                    {"line 1", "no column named x; the file has Hoch, Rechts, Oben: --columns Hoch,Rechts,Oben"});
  expect_unreadable("a.csv", "Longitude,Latitude,Height\n1,2,3\n", {"line 1", "degrees", "project"});
}

TEST(TextReader, ColumnsThatTheCallerNames) {
  const testing::TemporaryFolder folder;
  const auto read = [&](std::string_view content, std::vector<std::string> columns) {
    return read_points(folder.write("a.csv", content), {.columns = std::move(columns)}).points;
  };
  EXPECT_EQ(read("Hoch,Rechts,Oben\n2,1,3\n5.5,-4,6\n", {"Rechts", "Hoch", "Oben"}), two_points);
  EXPECT_EQ(read("rechts [m];hoch [m];oben [m]\n1;2;3\n-4;5,5;6\n", {"Rechts", "Hoch", "Oben"}), two_points);
  EXPECT_EQ(read("Hoch,Rechts,Oben\n2,1,3\n5.5,-4,6\n", {"2", "1", "3"}), two_points);
  EXPECT_EQ(read("7 a 3 2 1\n7 b 6 5.5 -4\n", {"5", "4", "3"}), two_points);
  EXPECT_EQ(read("x,y,z\n0,1,2,3\n0,-4,5.5,6\n", {"2", "3", "4"}), two_points);
  testing::expect_file_error([&] { read("a,b,c\n1,2,3\n", {"a", "b", "d"}); }, {"line 1", "'d'", "a, b, c"});
  testing::expect_file_error(
      [&] {
        read("1,2,3\n", {"a", "b", "c"});
      },
      {"no line of the file names", "--columns 1,2,3"});
  testing::expect_file_error([&] { read("1,2,3\n", {"1", "2", "4"}); }, {"line 1", "too few"});
  EXPECT_THROW(read("1,2,3\n", {"1", "2"}), InvalidArgument);
  EXPECT_THROW(read("1,2,3\n", {"1", "2", ""}), InvalidArgument);
}

TEST(TextReader, AFirstColumnThatCountsRowsIsNotX) {
  EXPECT_EQ(read_content("a.txt", "0 1.0 2.0 3.0\n1 -4.0 5.5 6.0\n2 nan 0.0 0.0\n3 nan 0.0 0.0\n").points, two_points);
  expect_unreadable("a.txt", "7 10 20 30\n8 11 20 30\n9 13 20 30\n10 10 20 30\n", {"line 1", "--columns 2,3,4"});
  EXPECT_EQ(read_content("a.txt", "0 1 2\n1 1 2\n2 1 2\n3 1 2\n").points.size(), 4u);  // nothing else could be x
}

TEST(TextReader, BracketsQuotesAndLineEnds) {
  EXPECT_EQ(read_content("a.txt", "[[ 1. 2. 3.]\n [-4. 5.5 6.]]\n").points, two_points);
  EXPECT_EQ(read_content("a.txt", "(1, 2, 3)\n(-4, 5.5, 6)\n").points, two_points);
  EXPECT_EQ(read_content("a.csv", "\"id\",\"x\",\"y\",\"z\"\n\"a, b\",\"1\",\"2\",\"3\"\n\"c\",\"-4\",\"5.5\",\"6\"\n")
                .points,
            two_points);
  EXPECT_EQ(read_content("a.xyz", "1 2 3\r-4 5.5 6\r").points, two_points);
  EXPECT_EQ(read_content("a.xyz", "1 2 3\r\r\n-4 5.5 6\r\r\n").points, two_points);
  EXPECT_EQ(read_content("a.asc", "//X Y Z I\n2\n1 2 3 9\n-4 5.5 6 9\n").points, two_points);
}

std::string utf16(std::string_view text, bool big, bool mark) {
  std::string bytes = mark ? (big ? "\xFE\xFF" : "\xFF\xFE") : "";
  for (const char c : text) bytes += big ? std::string{'\0', c} : std::string{c, '\0'};
  return bytes;
}

TEST(TextReader, Utf16) {
  for (const bool big : {false, true}) {
    for (const bool mark : {false, true}) {
      EXPECT_EQ(read_content("a.csv", utf16("x;y;z\r\n1;2;3\r\n-4;5,5;6\r\n", big, mark)).points, two_points);
    }
  }
  std::string long_text;
  for (int i = 0; i < 200000; ++i) long_text += "1.25 2.5 " + std::to_string(i % 7) + ".5\n";
  EXPECT_EQ(read_content("a.xyz", utf16(long_text, false, true)).points, read_content("a.xyz", long_text).points);
}

// 32,000 letters of two units each, one of which lies across the border of what is read at once; four bytes in UTF-8.
TEST(TextReader, Utf16OfTwoUnitsALetter) {
  for (const bool big : {false, true}) {
    const std::string letter = big ? std::string("\xD8\x3D\xDE\x00", 4) : std::string("\x3D\xD8\x00\xDE", 4);
    for (const std::string_view start : {"1 2 3\n# ", "1 2 3\n#  "}) {
      std::string text = utf16(start, big, true);
      for (int i = 0; i < 32000; ++i) text += letter;
      EXPECT_EQ(read_content("a.xyz", text + utf16("\n-4 5.5 6\n", big, false)).points, two_points);
      expect_unreadable("a.xyz", text + utf16("\n-4 5.5 ", big, false) + letter,
                        {"line 3: '" + std::string(4, '?') + "'"});
    }
  }
}

TEST(TextReader, BlocksOfPts) {
  EXPECT_EQ(read_content("a.pts", "1\n1 2 3 0 0 0 0\n\n1\n-4 5.5 6 0 0 0 0\n").points, two_points);
  expect_unreadable("a.pts", "1\n1 2 3 0 0 0 0\n3\n-4 5.5 6 0 0 0 0\n", {"line 4", "2 points too early"});
}

TEST(TextReader, ChemistsFiles) {
  EXPECT_EQ(read_content("a.xyz", "2\nproduced by a chemist\nC 1 2 3\nH -4 5.5 6\n").points, two_points);
}

TEST(TextReader, WhatIsNoTextOfPointsSaysWhatItIs) {
  expect_unreadable("a.asc", "ncols 4\nnrows 2\nxllcorner 0\n1 2 3 4\n5 6 7 8\n", {"line 1", "grid"});
  expect_unreadable("a.txt", "2\n1\n0 0 0\n", {"line 2", ".ptx"});
  expect_unreadable("a.txt", "OFF\n1 0 0\n0 0 0\n", {"line 1", "mesh"});
  expect_unreadable("a.obj", "v 1 2 3\n", {"mesh", ".ply"});
  expect_unreadable("a.vtk", "# vtk DataFile\n", {".ply"});
  expect_unreadable("a.txt", std::string("1 2 3\n4 5\0 6\n", 13), {"byte offset 9", "binary"});
}

}  // namespace
}  // namespace igsp::io
