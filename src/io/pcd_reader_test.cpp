#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "io/io_testing.hpp"

namespace igsp::io {
namespace {

using testing::bytes_of;
using testing::expect_unreadable;
using testing::read_content;

const Points two_points = {{1, 2, 3}, {-4, 5.5, 6}};

struct Header {
  std::string fields = "x y z", size = "4 4 4", type = "F F F", count = "1 1 1", width = "2", height = "1",
              points = "2";

  std::string operator()(const std::string& data) const {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " +
           type + "\nCOUNT " + count + "\nWIDTH " + width + "\nHEIGHT " + height +
           "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
  }
};

/// The colour first, then z as an integer, a histogram of three values, y as double, padding, x as float.
const Header mixed = {
    .fields = "rgb z histogram y _ x", .size = "4 2 4 8 1 4", .type = "U I F F U F", .count = "1 1 3 1 5 1"};

std::string mixed_rows() {
  std::string body;
  for (const auto& point : two_points) {
    body += bytes_of(0xFF00FFu) + bytes_of(static_cast<std::int16_t>(point.z())) + bytes_of(0.5f) + bytes_of(1.5f) +
            bytes_of(2.5f) + bytes_of(point.y()) + "....." + bytes_of(static_cast<float>(point.x()));
  }
  return body;
}

std::string mixed_columns() {
  std::string body;
  for (int i = 0; i < 2; ++i) body += bytes_of(0xFF00FFu);
  for (const auto& point : two_points) body += bytes_of(static_cast<std::int16_t>(point.z()));
  for (int i = 0; i < 6; ++i) body += bytes_of(0.5f);
  for (const auto& point : two_points) body += bytes_of(point.y());
  body += "..........";
  for (const auto& point : two_points) body += bytes_of(static_cast<float>(point.x()));
  return body;
}

/// LZF by hand: runs of at most 32 bytes that stand for themselves, each behind its length - 1.
std::string compressed_by_hand(const std::string& bytes) {
  std::string body;
  for (std::size_t i = 0; i < bytes.size(); i += 32) {
    const std::string run = bytes.substr(i, 32);
    body += static_cast<char>(run.size() - 1) + run;
  }
  return bytes_of(static_cast<std::uint32_t>(body.size())) + bytes_of(static_cast<std::uint32_t>(bytes.size())) + body;
}

TEST(PcdReader, WrittenByHandByteByByte) {
  const std::string x1 = {0, 0, '\x80', '\x3F'}, y1 = {0, 0, 0, '\x40'}, z1 = {0, 0, '\x40', '\x40'};       // 1 2 3
  const std::string x2 = {0, 0, '\x80', '\xC0'}, y2 = {0, 0, '\xB0', '\x40'}, z2 = {0, 0, '\xC0', '\x40'};  // -4 5.5 6
  EXPECT_EQ(read_content("a.pcd", Header()("binary") + x1 + y1 + z1 + x2 + y2 + z2).points, two_points);
  const std::string sizes = {25, 0, 0, 0, 24, 0, 0, 0, 23};  // compressed, whole, a run of 23 + 1 bytes
  const LoadedCloud cloud = read_content("a.pcd", Header()("binary_compressed") + sizes + x1 + x2 + y1 + y2 + z1 + z2);
  EXPECT_EQ(cloud.points, two_points);
  EXPECT_EQ(cloud.format, FileFormat::pcd_binary_compressed);
  EXPECT_EQ(read_content("a.pcd", Header()("ascii") + "1 2 3\n-4 5.5 6\n").points, two_points);
}

TEST(PcdReader, FieldsInAnyOrderSizeTypeAndCount) {
  EXPECT_EQ(read_content("a.pcd", mixed("ascii") + "9 3 1 2 3 2 1 2 3 4 5 1\n9 6 1 2 3 5.5 1 2 3 4 5 -4\n").points,
            two_points);
  EXPECT_EQ(read_content("a.pcd", mixed("binary") + mixed_rows()).points, two_points);
  EXPECT_EQ(read_content("a.pcd", mixed("binary_compressed") + compressed_by_hand(mixed_columns())).points, two_points);
}

template <typename Scalar>
void expect_read_as(const std::string& type, double largest) {
  const std::string size = std::to_string(sizeof(Scalar));
  Header header;
  header.size = size + " " + size + " " + size;
  header.type = type + " " + type + " " + type;
  header.width = header.points = "1";
  const auto body = bytes_of(Scalar{1}) + bytes_of(static_cast<Scalar>(largest)) + bytes_of(Scalar{3});
  EXPECT_EQ(read_content("a.pcd", header("binary") + body).points, Points({{1, largest, 3}})) << type << size;
}

TEST(PcdReader, EveryScalarType) {
  expect_read_as<std::int8_t>("I", -128);
  expect_read_as<std::uint8_t>("U", 255);
  expect_read_as<std::int16_t>("I", -32768);
  expect_read_as<std::uint16_t>("U", 65535);
  expect_read_as<std::int32_t>("I", -2147483648.0);
  expect_read_as<std::uint32_t>("U", 4294967295.0);
  expect_read_as<std::int64_t>("I", -9223372036854775808.0);
  expect_read_as<std::uint64_t>("U", 9223372036854775808.0);
  expect_read_as<float>("F", 0.5);
  expect_read_as<double>("F", 0.1);
}

TEST(PcdReader, OrganisedCloudsLoseTheirHoles) {
  Header header;
  header.width = "2", header.height = "3", header.points = "6";
  const std::string hole = bytes_of(std::nanf("")) + bytes_of(std::nanf("")) + bytes_of(std::nanf(""));
  std::string rows;
  for (const auto& point : two_points) {
    rows += hole + hole;
    for (const double value : point) rows += bytes_of(static_cast<float>(value));
  }
  const LoadedCloud binary = read_content("a.pcd", header("binary") + rows);
  EXPECT_EQ(binary.points, two_points);
  EXPECT_EQ(binary.dropped, 4u);
  const LoadedCloud ascii =
      read_content("a.pcd", header("ascii") + "nan nan nan\nNaN 1 1\n1 2 3\n1 -nan 1\n1 1 inf\n-4 5.5 6\n");
  EXPECT_EQ(ascii.points, two_points);
  EXPECT_EQ(ascii.dropped, 4u);
}

TEST(PcdReader, OldAndShortHeaders) {
  EXPECT_EQ(read_content("a.pcd", "COLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n").points.size(),
            1u);
  EXPECT_EQ(read_content("a.pcd", "# made by hand\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nDATA ascii\n1 2 3\n")
                .points.size(),
            1u);
  EXPECT_EQ(read_content("a.pcd",
                         "VERSION .7\r\nFIELDS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nWIDTH 1\r\nDATA ascii\r\n1 2 3\r\n")
                .points.size(),
            1u);
}

TEST(PcdReader, ZeroPointsAreNoError) {
  Header header;
  header.width = header.points = "0";
  for (const auto data : {"ascii", "binary", "binary_compressed"}) {
    EXPECT_TRUE(read_content("a.pcd", header(data)).points.empty()) << data;
  }
}

TEST(PcdReader, BadHeadersNameTheLine) {
  expect_unreadable("a.pcd", "PLD\n", {"byte offset 0", "not a PCD file"});
  expect_unreadable("a.pcd", "VERSION 0.7\nFIELD x y z\n", {"line 2", "'FIELD'"});
  expect_unreadable("a.pcd", "VERSION 0.7\nVERSION 0.7\n", {"line 2", "second VERSION"});
  expect_unreadable("a.pcd", "VERSION 0.7\nFIELDS x y z\n", {"line 2", "truncated"});
  expect_unreadable("a.pcd", "VERSION 0.7\nDATA ascii\n", {"line 2", "FIELDS"});
  const auto bad = [](auto change) {
    Header header;
    change(header);
    return header("binary") + std::string(24, '\0');
  };
  expect_unreadable("a.pcd", bad([](Header& h) { h.size = "4 4"; }), {"line 4", "2 values for 3 fields"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.size = "4 4 four"; }), {"line 4", "'four'"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.size = "4 4 2"; }), {"unknown type", "'z'", "SIZE 2"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.type = "F F Q"; }), {"unknown type", "'Q'"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.type = "F F FF"; }), {"line 5", "'FF'"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.count = "1 1 -1"; }), {"line 6", "'-1'"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.count = "1 1 3"; }), {"'z'", "COUNT 3"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.count = "1 1 4294967296"; }), {"line 6", "4294967296"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.fields = "x y w"; }), {"'z'"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.fields = "x y y"; }), {"2 fields named 'y'"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.points = "3"; }), {"line 11", "POINTS 3", "WIDTH 2"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.width = "two"; }), {"line 7", "'two'"});
  expect_unreadable("a.pcd", bad([](Header& h) { h.width = h.height = "4294967296"; }), {"line 11", "WIDTH"});
  expect_unreadable("a.pcd", Header()("base64"), {"line 11", "DATA"});
}

TEST(PcdReader, BadLinesNameTheLine) {
  expect_unreadable("a.pcd", Header()("ascii") + "1 2 3\n1.25 2\n", {"line 13", "too few"});
  expect_unreadable("a.pcd", Header()("ascii") + "1 2 3\n1 2 three\n", {"line 13", "'three'"});
  expect_unreadable("a.pcd", Header()("ascii") + "1 2 3\n1 2 3 4\n", {"line 13", "more values"});
  expect_unreadable("a.pcd", Header()("ascii") + "1 2 3    \n\n\n", {"line 14", "truncated"});
}

TEST(PcdReader, CountsThatTheFileCannotHoldFailBeforeAnyAllocation) {
  Header header;
  header.width = header.points = "1000000000000000000";
  for (const auto data : {"ascii", "binary"}) {
    const std::string start = header(data);
    expect_unreadable("a.pcd", start + "1 2 3\n", {"byte offset " + std::to_string(start.size()), header.points});
  }
  const std::string start = header("binary_compressed");
  expect_unreadable("a.pcd", start + compressed_by_hand(std::string(24, 'a')),
                    {"byte offset " + std::to_string(start.size() + 4), header.points});
}

TEST(PcdReader, DamagedBodiesNameTheByte) {
  const std::string binary = Header()("binary"), compressed = Header()("binary_compressed");
  const auto at = [](const std::string& start, int more) {
    return "byte offset " + std::to_string(start.size() + more);
  };
  expect_unreadable("a.pcd", binary + std::string(23, '\0'), {at(binary, 0), "23 bytes follow"});
  const std::string body = compressed_by_hand(std::string(24, 'a'));
  ASSERT_EQ(read_content("a.pcd", compressed + body).points.size(), 2u);
  expect_unreadable("a.pcd", compressed + body.substr(0, 5), {at(compressed, 5), "truncated"});
  expect_unreadable("a.pcd", compressed + body.substr(0, body.size() - 1), {at(compressed, 8), "24 bytes follow"});
  std::string damaged = body;
  damaged[8] = '\xFF';  // a reference to before the beginning
  expect_unreadable("a.pcd", compressed + damaged, {at(compressed, 8), "damaged"});
  expect_unreadable("a.pcd", compressed + compressed_by_hand(std::string(25, 'a')), {at(compressed, 4), "25 bytes"});
  expect_unreadable("a.pcd", compressed + compressed_by_hand(std::string(36, 'a')), {at(compressed, 4), "36 bytes"});
}

/// 5 bytes that claim to be 100 million points: refused by LZF's best ratio, not by running out of memory.
TEST(PcdReader, ACompressedBodyCannotClaimMoreThanItsRatio) {
  Header header;
  header.width = header.points = "100000000";
  const std::string start = header("binary_compressed");
  expect_unreadable("a.pcd", start + bytes_of(5u) + bytes_of(1200000000u) + "12345",
                    {"byte offset " + std::to_string(start.size()), "1200000000"});
}

TEST(PcdReader, TheBestRatioIsReadable) {
  const testing::TemporaryFolder folder;
  const Points points(100000, Eigen::Vector3d::Zero());
  write_points(folder / "a.pcd", points, {.format = FileFormat::pcd_binary_compressed});
  EXPECT_LT(file_size(folder / "a.pcd"), 40000u);  // of 2.4 MB: it does compress
  EXPECT_EQ(read_points(folder / "a.pcd").points, points);
}

TEST(PcdReader, AnEndlessHeaderIsGivenUp) {
  std::string lines = "# .PCD v0.7\n";
  while (lines.size() < std::size_t{3} << 20) lines += "# and so on\n";
  expect_unreadable("a.pcd", lines, {"line", "1 MiB"});
}

TEST(PcdReader, CapitalNamesSmallTypesAndAByteOrderMark) {
  const std::string body = "1 2 3\n-4 5.5 6\n";
  EXPECT_EQ(read_content("a.pcd", Header{.fields = "X Y Z"}("ascii") + body).points, two_points);
  EXPECT_EQ(read_content("a.pcd", Header{.type = "f f f"}("ascii") + body).points, two_points);
  EXPECT_EQ(read_content("a.pcd", "\xEF\xBB\xBF" + Header{}("ascii") + body).points, two_points);
}

TEST(PcdReader, RefusalsSayWhatWouldHelp) {
  expect_unreadable("a.pcd", Header{}("ascii") + "1,2,3\n-4,5.5,6\n", {"line 12", "replace the commas"});
  std::string later = Header{}("ascii") + "1 2 3\n-4 5.5 6\n";
  later.replace(later.find("VERSION 0.7"), 11, "VERSION 3.0");
  expect_unreadable("a.pcd", later, {"line 2", "'3.0' is not supported", "0.7"});
  expect_unreadable("a.pcd", Header{.width = "3"}("ascii"), {"POINTS 2 is not WIDTH 3", "WIDTH = POINTS"});
  expect_unreadable("a.pcd", Header{.fields = "a b c"}("ascii"), {"'x'", "it has a, b, c"});
}

}  // namespace
}  // namespace igsp::io
