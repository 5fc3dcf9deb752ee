#include "io/moved_copy.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "io/io_testing.hpp"

namespace igsp::io {
namespace {

using testing::bytes_of;
using testing::read_bytes;
using testing::TemporaryFolder;

/// A quarter turn about z, whose products are exact, and a shift.
Transformation quarter_turn() {
  Transformation motion = Transformation::Identity();
  motion.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  motion.translation() = Eigen::Vector3d(10, 20, 30);
  return motion;
}

std::string moved_content(std::string_view name, std::string_view content,
                          const Transformation& motion = quarter_turn(), const MoveOptions& options = {}) {
  const TemporaryFolder folder;
  const auto source = folder.write(name, content);
  const auto destination = folder / ("moved_" + std::string(name));
  write_moved(source, destination, motion, options);
  EXPECT_EQ(folder.files(), 2u);
  return read_bytes(destination);
}

std::string replaced(std::string text, std::string_view old, std::string_view now) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, text.npos) << old;
  return text.replace(at, old.size(), now);
}

const std::string ascii_ply =
    "ply\nformat ascii 1.0\ncomment made by hand\nobj_info a scan\nelement camera 1\nproperty float view_px\n"
    "property float view_py\nproperty float view_pz\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
    "property list uchar int seen_by\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 5\n"
    "1 2 3 1 0 0 255 2 7 8\n"
    "nan nan nan 0 1 0 4 0\n"
    "-1.50 0 0.25  0 0 1  9 1 6\n"
    "3 0 1 2\n";

TEST(MovedCopy, AsciiPlyKeepsAllThatDoesNotMove) {
  std::string expected = replaced(ascii_ply, "0 0 5\n", "10 20 35\n");
  expected = replaced(expected, "1 2 3 1 0 0 255 2 7 8", "8 21 33 0 1 0 255 2 7 8");
  expected = replaced(expected, "0 1 0 4 0", "-1 0 0 4 0");  // the normal of a point without a position turns
  expected = replaced(expected, "-1.50 0 0.25  0 0 1  9 1 6", "10 18.5 30.25  0 0 1  9 1 6");
  EXPECT_EQ(moved_content("cloud.ply", ascii_ply), expected);
}

/// Faces before and behind, lists between the coordinates.
std::string binary_ply(std::endian order, double shift, bool lists, bool doubles = false) {
  const auto number = [&](double value) {
    return doubles ? bytes_of(value, order) : bytes_of(static_cast<float>(value), order);
  };
  const std::string type = doubles ? "double" : "float";
  std::string text = "ply\nformat binary_" + std::string(order == std::endian::big ? "big" : "little") +
                     "_endian 1.0\ncomment kept\nelement material 1\nproperty int id\nelement vertex 2\nproperty " +
                     type + " z\nproperty uchar red\nproperty " + type + " y\n" +
                     (lists ? "property list uchar short seen_by\n" : "") + "property " + type +
                     " x\nproperty float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
                     "property list uchar int vertex_indices\nend_header\n" +
                     bytes_of(std::int32_t{7}, order);
  // (1, 2, 3) turned to (-2, 1, 3) and moved; its normal along x turned to y.
  const bool moved = shift != 0.0;
  const auto seen = lists ? "\x02" + bytes_of(std::int16_t{4}, order) + bytes_of(std::int16_t{5}, order) : "";
  text += number(3 + 3 * shift) + "\xFF" + number(moved ? 1 + 2 * shift : 2) + seen + number(moved ? -2 + shift : 1);
  text += bytes_of(moved ? 0.0f : 1.0f, order) + bytes_of(moved ? 1.0f : 0.0f, order) + bytes_of(0.0f, order);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  text += number(nan) + "\x01" + number(nan) + (lists ? std::string(1, '\0') : "") + number(nan);
  for (int axis = 0; axis < 3; ++axis) text += bytes_of(0.0f, order);
  return text + "\x03" + bytes_of(std::int32_t{0}, order) + bytes_of(std::int32_t{1}, order) +
         bytes_of(std::int32_t{1}, order) + "behind all";
}

TEST(MovedCopy, AsciiPlyWhoseListsComeBeforeTheCoordinates) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty list uchar int seen_by\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  EXPECT_EQ(moved_content("a.ply", header + "3 7 8 9 1 2 3\n0 0 0 0\n"), header + "3 7 8 9 8 21 33\n0 10 20 30\n");
}

TEST(MovedCopy, BinaryPlyOfBothByteOrders) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    for (const bool lists : {false, true}) {
      const std::string still = binary_ply(order, 0, lists);
      EXPECT_EQ(moved_content("cloud.ply", still, Transformation::Identity()), still);
      EXPECT_EQ(moved_content("cloud.ply", still), binary_ply(order, 10, lists)) << lists;
      // NaN as float and as double are bits of their own: compared by what is read.
      const std::string wide = moved_content("cloud.ply", still, quarter_turn(), {.doubles = true});
      EXPECT_EQ(wide.size(), binary_ply(order, 10, lists, true).size());
      EXPECT_EQ(wide.substr(0, 250), binary_ply(order, 10, lists, true).substr(0, 250));
      EXPECT_EQ(testing::read_content("wide.ply", wide).points, (Points{{8, 21, 33}}));
    }
  }
}

TEST(MovedCopy, FloatsBecomeDoublesWhereAsked) {
  Transformation far = Transformation::Identity();
  far.translation() = Eigen::Vector3d(456789.125, 5400000.0625, 0);
  const TemporaryFolder folder;
  const auto source = folder / "a.ply";
  write_points(source, Points{{0.0078125, 0.5, 1}}, {.format = {}, .single_precision = true});
  EXPECT_TRUE(write_moved(source, folder / "b.ply", far, {.doubles = true}));
  EXPECT_EQ(read_points(folder / "b.ply").points, (Points{{456789.1328125, 5400000.5625, 1}}));
  EXPECT_FALSE(write_moved(source, folder / "c.ply", far));
  EXPECT_FALSE(write_moved(folder / "b.ply", folder / "d.ply", far, {.doubles = true})) << "doubles already";
  EXPECT_EQ(read_points(folder / "c.ply").points, (Points{{456789.125, 5400000.5, 1}})) << "floats stay floats";
}

TEST(MovedCopy, IntegerCoordinatesBecomeDoubles) {
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty short x\nproperty short y\nproperty short z\n"
      "property uchar red\nend_header\n" +
      bytes_of(std::int16_t{1}) + bytes_of(std::int16_t{2}) + bytes_of(std::int16_t{3}) + "\x09";
  Transformation half = Transformation::Identity();
  half.translation() = Eigen::Vector3d(0.5, 40000, 0);
  const std::string moved = moved_content("a.ply", ply, half);
  EXPECT_EQ(testing::read_content("a.ply", moved).points, (Points{{1.5, 40002, 3}}));
  EXPECT_EQ(moved.back(), '\x09');
  EXPECT_NE(moved.find("property double x\nproperty double y\nproperty double z\nproperty uchar red"), moved.npos);
}

std::string pcd_header(std::string_view data, std::string_view viewpoint = "0 0 0 1 0 0 0") {
  return "# .PCD v0.7 - Point Cloud Data file format\n# a comment\nVERSION 0.7\nFIELDS x y z rgb normal_x normal_y "
         "normal_z _\nSIZE 4 4 4 4 4 4 4 1\nTYPE F F F F F F F U\nCOUNT 1 1 1 1 1 1 1 4\nWIDTH 2\nHEIGHT "
         "2\nVIEWPOINT " +
         std::string(viewpoint) + "\nPOINTS 4\nDATA " + std::string(data) + "\n";
}

/// Four cells in two rows, one of them empty; `order` as in the file: by point or by field.
std::string pcd_body(bool by_field, bool moved) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::vector<float>> before = {
      {1, 2, 3, 0.5f, 1, 0, 0}, {nan, nan, nan, 7, nan, nan, nan}, {0, 0, 0, 1, 0, 1, 0}, {4, 0, -1, 2, 0, 0, 1}};
  const std::vector<std::vector<float>> after = {{8, 21, 33, 0.5f, 0, 1, 0},
                                                 {nan, nan, nan, 7, nan, nan, nan},
                                                 {10, 20, 30, 1, -1, 0, 0},
                                                 {10, 24, 29, 2, 0, 0, 1}};
  const auto& cells = moved ? after : before;
  std::string bytes;
  if (!by_field) {
    for (const auto& cell : cells) {
      for (const float value : cell) bytes += bytes_of(value);
      bytes += "pads";
    }
    return bytes;
  }
  for (std::size_t field = 0; field < 7; ++field) {
    for (const auto& cell : cells) bytes += bytes_of(cell[field]);
  }
  return bytes + "padspadspadspads";
}

TEST(MovedCopy, PcdKeepsItsRowsEmptyCellsAndMovesItsViewpoint) {
  const std::string still = pcd_header("binary", "1 2 3 1 0 0 0") + pcd_body(false, false);
  EXPECT_EQ(moved_content("a.pcd", still, Transformation::Identity()), still);
  const std::string moved = moved_content("a.pcd", still);
  const std::string root = "0.707106781186547";
  EXPECT_NE(moved.find("VIEWPOINT 8 21 33 " + root), moved.npos) << moved.substr(0, 300);
  const std::size_t begin = moved.find("VIEWPOINT"), end = moved.find('\n', begin);
  const std::string line = moved.substr(begin, end - begin);
  EXPECT_EQ(line.find(" 0 0 " + root), line.rfind(' ') - 4) << line;  // x and y of the quaternion, then z
  EXPECT_EQ(moved.substr(0, begin), still.substr(0, begin));
  EXPECT_EQ(moved.substr(moved.find("POINTS")), still.substr(still.find("POINTS"), 21) + pcd_body(false, true));
}

TEST(MovedCopy, CompressedPcd) {
  // LZF may leave all bytes literal: 32 at a time behind their number less one.
  const auto compressed = [](const std::string& body) {
    std::string literal;
    for (std::size_t i = 0; i < body.size(); i += 32) {
      const std::string part = body.substr(i, 32);
      literal += static_cast<char>(part.size() - 1) + part;
    }
    return bytes_of(static_cast<std::uint32_t>(literal.size())) + bytes_of(static_cast<std::uint32_t>(body.size())) +
           literal;
  };
  const TemporaryFolder folder;
  const auto source =
      folder.write("a.pcd", pcd_header("binary_compressed") + compressed(pcd_body(true, false)) + "behind");
  write_moved(source, folder / "b.pcd", quarter_turn());
  EXPECT_EQ(read_points(folder / "b.pcd").points, (Points{{8, 21, 33}, {10, 20, 30}, {10, 24, 29}}));
  EXPECT_EQ(read_points(folder / "b.pcd").dropped, 1u);
  EXPECT_EQ(read_points(folder / "b.pcd").format, FileFormat::pcd_binary_compressed);
  write_moved(folder / "b.pcd", folder / "c.pcd", quarter_turn().inverse());  // back again, normals with it
  write_moved(source, folder / "d.pcd", Transformation::Identity());
  EXPECT_EQ(read_bytes(folder / "c.pcd").substr(read_bytes(folder / "c.pcd").find("POINTS")),
            read_bytes(folder / "d.pcd").substr(read_bytes(folder / "d.pcd").find("POINTS")));
  EXPECT_TRUE(read_bytes(folder / "c.pcd").ends_with("behind"));
  write_moved(source, folder / "e.pcd", quarter_turn(), {.doubles = true});
  EXPECT_EQ(read_points(folder / "e.pcd").points, read_points(folder / "b.pcd").points);
  EXPECT_NE(read_bytes(folder / "e.pcd").find("SIZE 8 8 8 4 4 4 4 1\nTYPE F F F F F F F U\n"), std::string::npos);
}

TEST(MovedCopy, AsciiPcd) {
  const std::string content = pcd_header("ascii") +
                              "1 2 3 0.5 1 0 0 9 9 9 9\nnan nan nan 7 nan nan nan 9 9 9 9\n0 0 0 1 0 1 0 9 9 9 9\n"
                              "4 0 -1 2 0 0 1 9 9 9 8\n";
  const std::string moved = moved_content("a.pcd", content);
  EXPECT_TRUE(
      moved.ends_with("DATA ascii\n8 21 33 0.5 0 1 0 9 9 9 9\nnan nan nan 7 nan nan nan 9 9 9 9\n"
                      "10 20 30 1 -1 0 0 9 9 9 9\n10 24 29 2 0 0 1 9 9 9 8\n"))
      << moved;
}

TEST(MovedCopy, TextKeepsItsLinesItsNamesAndItsMarks) {
  struct Case {
    std::string name, before, after;
  };
  for (const auto& [name, before, after] : std::vector<Case>{
           {"a.xyz", "# scan\n1 2 3 77 a\n\n-1\t0 0.250\t78 b", "# scan\n8 21 33 77 a\n\n10\t19 30.25\t78 b"},
           {"a.csv", "Intensity,X,Y,Z,Nx,Ny,Nz\r\n7,1,2,3,1,0,0\r\n8,0,0,0,0,0,1\r\n",
            "Intensity,X,Y,Z,Nx,Ny,Nz\r\n7,8,21,33,0,1,0\r\n8,10,20,30,0,0,1\r\n"},
           {"b.csv", "Rechts;Hoch;X;Y;Z\n1;2;1,5;2,5;3,0\n", "Rechts;Hoch;X;Y;Z\n1;2;7,5;21,5;33\n"},
           {"c.csv", "\"x\",\"y\",\"z\",\"name\"\n\"1\",\"2\",\"3\",\"tree, old\"\n",
            "\"x\",\"y\",\"z\",\"name\"\n\"8\",\"21\",\"33\",\"tree, old\"\n"},
           {"a.txt", "[1, 2, 3]\n[4, 0, -1]\n", "[8, 21, 33]\n[10, 24, 29]\n"},
           {"a.xyzn", "1 2 3 1 0 0\n", "8 21 33 0 1 0\n"},
           {"a.pts", "2\n1 2 3 -100 9 9 9\n4 0 -1 50 8 8 8\n1\n0 0 0 1 2 3 4\n",
            "2\n8 21 33 -100 9 9 9\n10 24 29 50 8 8 8\n1\n10 20 30 1 2 3 4\n"},
           {"b.xyz", "1 2 3 9\nnan nan nan 8\n", "8 21 33 9\nnan nan nan 8\n"}}) {
    EXPECT_EQ(moved_content(name, before), after) << name;
    EXPECT_EQ(moved_content(name, before, Transformation::Identity()), before) << name;
  }
}

TEST(MovedCopy, ColumnsThatTheCallerNames) {
  const MoveOptions options{.read = {{"3", "2", "1"}}, .doubles = false, .progress = {}};
  EXPECT_EQ(moved_content("a.txt", "3 2 1 5\n", quarter_turn(), options), "33 21 8 5\n");
}

TEST(MovedCopy, OnlyTheSameKindOfFileKeepsTheProperties) {
  const TemporaryFolder folder;
  folder.write("a.ply", ascii_ply);
  folder.write("a.pcd", pcd_header("ascii") + "1 2 3 4 5 6 7 8 8 8 8\n");
  folder.write("a.xyz", "1 2 3 4\n5 6 7 8\n");
  folder.write("a.csv", "x,y,z,red\n1,2,3,4\n");
  EXPECT_TRUE(keeps_properties(folder / "a.ply", folder / "b.PLY"));
  EXPECT_TRUE(keeps_properties(folder / "a.xyz", folder / "b.txt"));
  for (const auto& [from, to] : {std::pair{"a.ply", "b.pcd"}, {"a.pcd", "b.xyz"}, {"a.xyz", "b.csv"}}) {
    EXPECT_FALSE(keeps_properties(folder / from, folder / to)) << from << to;
  }
  EXPECT_EQ(other_properties(folder / "a.ply"),
            (std::vector<std::string>{"nx", "ny", "nz", "red", "seen_by", "1 x camera", "1 x face"}));
  EXPECT_EQ(other_properties(folder / "a.pcd"), (std::vector<std::string>{"rgb", "normal_x", "normal_y", "normal_z"}));
  EXPECT_EQ(other_properties(folder / "a.xyz"), std::vector<std::string>{"column 4"});
  EXPECT_EQ(other_properties(folder / "a.csv"), std::vector<std::string>{"red"});
}

/// Cut anywhere, a file is refused or, where nobody can tell (text within its last number, a last line), written; never
/// is anything left behind.
TEST(MovedCopy, CutFilesAreRefusedAndLeaveNothing) {
  for (const auto& [name, content] :
       std::vector<std::pair<std::string, std::string>>{{"a.ply", ascii_ply},
                                                        {"a.ply", binary_ply(std::endian::big, 0, true)},
                                                        {"a.ply", binary_ply(std::endian::little, 0, false)},
                                                        {"a.pcd", pcd_header("binary") + pcd_body(false, false)},
                                                        {"a.pts", "2\n1 2 3 -100\n4 0 -1 50\n"}}) {
    std::size_t refused = 0;
    for (std::size_t size = 1; size < content.size(); ++size) {
      const TemporaryFolder folder;
      const auto source = folder.write(name, content.substr(0, size));
      try {
        write_moved(source, folder / ("moved_" + name), quarter_turn());
      } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find(source.string()), std::string::npos) << error.what();
        ++refused;
        ASSERT_EQ(folder.files(), 1u) << size;
      }
    }
    EXPECT_GE(refused + 20, content.size()) << name;
  }
}

/// Bytes changed at random places: read or refused, in bounded memory, nothing left behind.
TEST(MovedCopy, DamagedFilesAreWrittenOrRefused) {
  std::uint64_t state = 1;
  const auto next = [&](std::uint64_t below) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (state >> 33) % below;
  };
  for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
           {"a.ply", ascii_ply},
           {"a.ply", binary_ply(std::endian::big, 0, true)},
           {"a.pcd", pcd_header("binary") + pcd_body(false, false)},
           {"a.pcd", pcd_header("binary_compressed") + pcd_body(true, false)},
           {"a.csv", "x;y;z;\"nx\";ny;nz\n1,5;2;3;1;0;0\n[2;3;4;0;0;1]\n"}}) {
    for (int attempt = 0; attempt < 300; ++attempt) {
      std::string damaged = content;
      for (std::uint64_t changes = 1 + next(4); changes > 0; --changes) {
        damaged[next(damaged.size())] = static_cast<char>(next(256));
      }
      const TemporaryFolder folder;
      const auto source = folder.write(name, damaged);
      try {
        write_moved(source, folder / ("moved_" + name), quarter_turn());
        EXPECT_EQ(folder.files(), 2u);
      } catch (const FileError&) {
        EXPECT_EQ(folder.files(), 1u);
      }
    }
  }
}

// Found by a fuzzer: out of the range of a float came infinity, and the point was lost for every reader.
TEST(MovedCopy, WhatAFloatCannotHoldIsRefusedAndLeavesNothing) {
  const std::string body =
      "VERSION 0.7\nFIELDS x y z\nSIZE 8 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ";
  const std::string binary = body + "binary\n" + bytes_of(1e50) + bytes_of(1.0f) + bytes_of(2.0f);
  for (const std::string& content : {body + "ascii\n1e50 1 2\n", binary}) {
    const TemporaryFolder folder;
    const auto source = folder.write("a.pcd", content);
    EXPECT_THROW(write_moved(source, folder / "b.pcd", quarter_turn()), FileError) << "x becomes y, a float";
    EXPECT_EQ(folder.files(), 1u);
  }
}

TEST(MovedCopy, CancelledLeavesNothing) {
  const TemporaryFolder folder;
  const auto source = folder.write("a.ply", ascii_ply);
  const MoveOptions options{.read = {}, .doubles = false, .progress = [](const Progress&) { return false; }};
  EXPECT_THROW(write_moved(source, folder / "b.ply", quarter_turn(), options), Cancelled);
  EXPECT_EQ(folder.files(), 1u);
}

/// More than one buffer, whose borders lie within records and lines; the same file may be source and destination.
TEST(MovedCopy, FilesLargerThanTheBuffer) {
  const TemporaryFolder folder;
  Points points;
  for (int i = 0; i < 200000; ++i) points.emplace_back(i * 0.001, 5e6 + i / 7.0, std::sin(i));
  for (const auto name : {"a.ply", "a.pcd", "a.xyz", "a.csv", "a.pts"}) {
    write_points(folder / name, points);
    write_moved(folder / name, folder / name, quarter_turn());
    const Points moved = read_points(folder / name).points;
    ASSERT_EQ(moved.size(), points.size()) << name;
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(moved[i], quarter_turn() * points[i]) << name << i;
  }
}

}  // namespace
}  // namespace igsp::io
