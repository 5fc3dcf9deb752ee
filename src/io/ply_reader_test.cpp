#include <gtest/gtest.h>

#include <bit>
#include <string>

#include "io/io_testing.hpp"

namespace igsp::io {
namespace {

using testing::bytes_of;
using testing::expect_unreadable;
using testing::read_content;

const Points two_points = {{1, 2, 3}, {-4, 5.5, 6}};

std::string ply(const std::string& format, const std::string& elements, const std::string& body) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + body;
}

std::string vertex(std::size_t count) {
  return "element vertex " + std::to_string(count) + "\nproperty float x\nproperty float y\nproperty float z\n";
}

template <typename Scalar>
std::string body_of(const Points& points, std::endian order) {
  std::string body;
  for (const auto& point : points) {
    for (const double value : point) body += bytes_of(static_cast<Scalar>(value), order);
  }
  return body;
}

template <typename Scalar>
void expect_read_as(const std::string& type, const Points& points) {
  std::string header = "element vertex " + std::to_string(points.size()) + "\n";
  for (const char axis : {'x', 'y', 'z'}) header += "property " + type + " " + axis + "\n";
  const auto little = ply("binary_little_endian", header, body_of<Scalar>(points, std::endian::little));
  const auto big = ply("binary_big_endian", header, body_of<Scalar>(points, std::endian::big));
  EXPECT_EQ(read_content("a.ply", little).points, points) << type;
  EXPECT_EQ(read_content("a.ply", big).points, points) << type;
  EXPECT_EQ(read_content("a.ply", big).format, FileFormat::ply_binary_big_endian);
}

TEST(PlyReader, EveryScalarTypeInBothByteOrders) {
  const Points whole = {{1, 2, 3}, {-100, 120, 7}}, positive = {{1, 2, 3}, {200, 255, 0}};
  for (const auto name : {"char", "int8"}) expect_read_as<std::int8_t>(name, whole);
  for (const auto name : {"uchar", "uint8"}) expect_read_as<std::uint8_t>(name, positive);
  for (const auto name : {"short", "int16"}) expect_read_as<std::int16_t>(name, whole);
  for (const auto name : {"ushort", "uint16"}) expect_read_as<std::uint16_t>(name, {{65535, 2, 256}});
  for (const auto name : {"int", "int32"}) expect_read_as<std::int32_t>(name, {{-70000, 2, 1 << 30}});
  for (const auto name : {"uint", "uint32"}) expect_read_as<std::uint32_t>(name, {{4294967295.0, 2, 256}});
  for (const auto name : {"float", "float32"}) expect_read_as<float>(name, two_points);
  for (const auto name : {"double", "float64"}) expect_read_as<double>(name, {{0.1, 5e6 + 1e-9, -1e-300}});
}

/// Something before, between and behind the coordinates, in another order and with mixed types.
const std::string mixed_vertex =
    "element vertex 2\nproperty uchar red\nproperty double z\nproperty float nx\nproperty short x\n"
    "property float y\nproperty int label\n";

TEST(PlyReader, OtherPropertiesAreSkippedAndOrderIsFree) {
  for (const auto order : {std::endian::little, std::endian::big}) {
    std::string body;
    for (const auto& point : two_points) {
      body += bytes_of(std::uint8_t{9}) + bytes_of(point.z(), order) + bytes_of(0.5f, order) +
              bytes_of(static_cast<std::int16_t>(point.x()), order) + bytes_of(static_cast<float>(point.y()), order) +
              bytes_of(std::int32_t{77}, order);
    }
    const auto* format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
    EXPECT_EQ(read_content("a.ply", ply(format, mixed_vertex, body)).points, two_points);
  }
  EXPECT_EQ(read_content("a.ply", ply("ascii", mixed_vertex, "9 3 0.5 1 2 77\n9 6 nan -4 5.5 -77\n")).points,
            two_points);
}

TEST(PlyReader, OtherElementsWithListsBeforeAndAfterAreSkipped) {
  const std::string elements =
      "element camera 1\nproperty float fx\nproperty double fy\n"
      "element nothing 5\n"
      "element face 2\nproperty list uchar int vertex_indices\nproperty list ushort double weights\nproperty char "
      "flag\n" +
      vertex(2) + "element edge 3\nproperty int a\n";
  for (const auto order : {std::endian::little, std::endian::big}) {
    std::string body = bytes_of(1.0f, order) + bytes_of(2.0, order);
    for (const std::uint8_t length : {3, 0}) {
      body += bytes_of(length);
      for (int i = 0; i < length; ++i) body += bytes_of(std::int32_t{i}, order);
      body += bytes_of(std::uint16_t{1}, order) + bytes_of(0.5, order) + bytes_of(std::int8_t{1});
    }
    body += body_of<float>(two_points, order) + "the edges are not looked at";
    const auto* format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
    EXPECT_EQ(read_content("a.ply", ply(format, elements, body)).points, two_points);
  }
  const std::string lines = "1 2\n3 0 1 2 1 0.5 1\n0 1 0.5 1\n1 2 3\n-4 5.5 6\nno number here\n";
  EXPECT_EQ(read_content("a.ply", ply("ascii", elements, lines)).points, two_points);
}

TEST(PlyReader, ListsInsideTheVertexAreSkipped) {
  const std::string elements =
      "element vertex 2\nproperty float x\nproperty list uint short neighbours\nproperty float y\nproperty uchar c\n"
      "property float z\nproperty list char double more\n";
  for (const auto order : {std::endian::little, std::endian::big}) {
    std::string body;
    for (const auto& point : two_points) {
      body += bytes_of(static_cast<float>(point.x()), order) + bytes_of(std::uint32_t{2}, order) + "....";
      body += bytes_of(static_cast<float>(point.y()), order) + "c" + bytes_of(static_cast<float>(point.z()), order);
      body += bytes_of(std::int8_t{1}) + "12345678";
    }
    const auto* format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
    EXPECT_EQ(read_content("a.ply", ply(format, elements, body)).points, two_points);
    expect_unreadable("a.ply", ply(format, elements, body.substr(0, body.size() - 1)), {"truncated", "byte offset"});
  }
  EXPECT_EQ(read_content("a.ply", ply("ascii", elements, "1 2 8 9 2 7 3 0\n-4 0 5.5 7 6 1 0.5\n")).points, two_points);
  expect_unreadable("a.ply", ply("ascii", elements, "1 2 8 9 2 7 3 0\n-4 9 5.5 7 6 1 0.5\n"), {"line 12", "list of 9"});
  expect_unreadable("a.ply", ply("ascii", elements, "1 2 8 9 2 7 3 0\n-4 -1 5.5 7 6 1 0.5\n"), {"line 12", "'-1'"});
}

TEST(PlyReader, ANegativeListLengthNamesItsByte) {
  const auto content =
      ply("binary_little_endian", "element face 1\nproperty list char int i\n" + vertex(0), "\xFF....");
  expect_unreadable("a.ply", content, {"byte offset " + std::to_string(content.size() - 5), "list"});
}

// Found by a fuzzer: 2^64 - 1 values, which is no double, times their size.
TEST(PlyReader, AListLongerThanBytesCanBeCountedNamesItsByte) {
  const auto content = ply("binary_little_endian", "element face 1\nproperty list uint64 double i\n" + vertex(0),
                           std::string(8, '\xFF') + "....");
  expect_unreadable("a.ply", content, {"byte offset " + std::to_string(content.size() - 12), "list"});
}

TEST(PlyReader, CommentsAndWindowsLineEnds) {
  const std::string header =
      "ply\r\ncomment made by hand\r\nformat binary_little_endian 1.0\r\nobj_info 7\r\nelement vertex 1\r\n"
      "property float x\r\nproperty float y\r\nproperty float z\r\nend_header\r\n";
  EXPECT_EQ(read_content("a.ply", header + body_of<float>({{1, 2, 3}}, std::endian::little)).points,
            Points({{1, 2, 3}}));
  const std::string ascii =
      "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\n"
      "property float z\r\nend_header\r\n1 2 3\r\n";
  EXPECT_EQ(read_content("a.ply", ascii).points, Points({{1, 2, 3}}));
}

TEST(PlyReader, TheBodyMayLookLikeALineEnd) {
  const float newline = std::bit_cast<float>(0x0A0A0A0A);
  const auto content = ply("binary_little_endian", vertex(1), std::string(12, '\n'));
  EXPECT_EQ(read_content("a.ply", content).points, Points({{newline, newline, newline}}));
}

TEST(PlyReader, NonFinitePointsAreDroppedAndCounted) {
  const LoadedCloud ascii = read_content("a.ply", ply("ascii", vertex(4), "1 2 3\nnan 0 0\n0 -inf 0\n-4 5.5 6\n"));
  EXPECT_EQ(ascii.points, two_points);
  EXPECT_EQ(ascii.dropped, 2u);
  const float infinity = std::numeric_limits<float>::infinity();
  const auto body = body_of<float>({{0, 0, infinity}, {1, 2, 3}, {0, std::nan(""), 0}, {-4, 5.5, 6}}, std::endian::big);
  const LoadedCloud binary = read_content("a.ply", ply("binary_big_endian", vertex(4), body));
  EXPECT_EQ(binary.points, two_points);
  EXPECT_EQ(binary.dropped, 2u);
}

TEST(PlyReader, ADroppedPointDoesNotEndAChunk) {
  const testing::TemporaryFolder folder;
  PointReader reader(folder.write("a.ply", ply("ascii", vertex(5), "nan 0 0\nnan 0 0\n1 2 3\nnan 0 0\n-4 5.5 6\n")), 1);
  EXPECT_EQ(reader.next_chunk()[0], two_points[0]);
  EXPECT_EQ(reader.next_chunk()[0], two_points[1]);
  EXPECT_TRUE(reader.next_chunk().empty());
  EXPECT_EQ(reader.dropped(), 3u);
}

TEST(PlyReader, ZeroPointsAreNoError) {
  for (const auto format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    EXPECT_TRUE(read_content("a.ply", ply(format, vertex(0), "")).points.empty());
  }
}

TEST(PlyReader, BadHeadersNameTheLine) {
  const std::string start = "ply\nformat ascii 1.0\n";
  expect_unreadable("a.ply", "obj\n", {"byte offset 0", "not a PLY file"});
  expect_unreadable("a.ply", "ply x\n", {"byte offset 0", "not a PLY file"});
  expect_unreadable("a.ply", "ply\nformat ascii 2.0\n", {"line 2", "format"});
  expect_unreadable("a.ply", "ply\nformat octal 1.0\n", {"line 2", "format"});
  expect_unreadable("a.ply", "ply\n" + vertex(0) + "end_header\n", {"line 6", "format"});
  expect_unreadable("a.ply", start + "element vertex\n", {"line 3", "element"});
  expect_unreadable("a.ply", start + "element vertex -1\n", {"line 3", "element"});
  expect_unreadable("a.ply", start + "element vertex 99999999999999999999\n", {"line 3", "element"});
  expect_unreadable("a.ply", start + "property float x\n", {"line 3", "before any element"});
  expect_unreadable("a.ply", start + "element vertex 1\nproperty quad x\n", {"line 4", "unknown property type 'quad'"});
  expect_unreadable("a.ply", start + "element f 1\nproperty list float int i\n", {"line 4", "'float'"});
  expect_unreadable("a.ply", start + "element vertex 1\nproperty float\n", {"line 4", "property"});
  expect_unreadable("a.ply", start + "elephant vertex 1\n", {"line 3", "'elephant'"});
  expect_unreadable("a.ply", start + "element vertex 1\n", {"line 3", "truncated"});
  expect_unreadable("a.ply", start + "element face 0\nend_header\n", {"line 4", "vertex"});
  expect_unreadable("a.ply", start + vertex(0) + vertex(0) + "end_header\n", {"line 11", "2 'vertex'"});
  expect_unreadable("a.ply", start + "element vertex 0\nproperty int x\nproperty int y\nend_header\n",
                    {"line 6", "'z'"});
  expect_unreadable("a.ply", start + vertex(0) + "property float x\nend_header\n", {"line 8", "2 vertex", "'x'"});
}

TEST(PlyReader, BadLinesNameTheLine) {
  expect_unreadable("a.ply", ply("ascii", vertex(2), "1 2 3\n4.25 5\n"), {"line 9", "too few"});
  expect_unreadable("a.ply", ply("ascii", vertex(2), "1 2 3\n4 five 6\n"), {"line 9", "'five' is not a number"});
  expect_unreadable("a.ply", ply("ascii", vertex(2), "1 2 3\n4 5 6x\n"), {"line 9", "'6x' is not a number"});
  expect_unreadable("a.ply", ply("ascii", vertex(2), "1 2 3\n4 5 1e999\n"), {"line 9", "'1e999'"});
  expect_unreadable("a.ply", ply("ascii", vertex(2), "1 2 3\n4 5 6 7\n"), {"line 9", "more values"});
  expect_unreadable("a.ply", ply("ascii", vertex(2), "1 2 3\n\n\n\n\n\n\n"), {"line 14", "truncated"});
}

/// The last two wrap to 0 bytes in 64 bits: 12 or 8 bytes times 2^62, 6 bytes times 2^63.
TEST(PlyReader, CountsThatTheFileCannotHoldFailBeforeAnyAllocation) {
  for (const std::string huge : {"18446744073709551615", "4611686018427387904", "9223372036854775808"}) {
    for (const auto format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
      std::string elements = vertex(0);
      elements.replace(elements.find(" 0\n"), 3, " " + huge + "\n");
      const auto content = ply(format, elements, "1 2 3\n4 5 6\n");
      const auto body = "byte offset " + std::to_string(content.size() - 12);
      expect_unreadable("a.ply", content, {body, huge, "12 bytes follow"});
      elements = "element other " + huge + "\nproperty double a\n" + vertex(1);
      expect_unreadable("a.ply", ply(format, elements, "1 2 3\n4 5 6\n"), {huge});
      elements = "element other " + huge + "\nproperty list int int a\n" + vertex(1);
      expect_unreadable("a.ply", ply(format, elements, std::string(40, '\0')), {huge});
    }
  }
}

TEST(PlyReader, ATruncatedBodyNamesWhereItBegins) {
  const auto content = ply("binary_little_endian", vertex(2), std::string(23, '\0'));
  expect_unreadable("a.ply", content, {"byte offset " + std::to_string(content.size() - 23), "23 bytes follow"});
}

TEST(PlyReader, AnEndlessHeaderIsGivenUp) {
  expect_unreadable("a.ply", "ply\nformat ascii 1.0\ncomment " + std::string(std::size_t{3} << 20, 'x'),
                    {"line 3", "longer than"});
  std::string lines = "ply\nformat ascii 1.0\n";
  while (lines.size() < std::size_t{3} << 20) lines += "comment and so on\n";
  expect_unreadable("a.ply", lines, {"line", "1 MiB"});
}

TEST(PlyReader, CapitalNamesLongIntegersAndOldLineEnds) {
  const Points two = {{1, 2, 3}, {-4, 5.5, 6}};
  const std::string capital = "element vertex 2\nproperty float X\nproperty float Y\nproperty float Z\n";
  std::string content = ply("ascii", capital, "1 2 3\n-4 5.5 6\n");
  EXPECT_EQ(read_content("a.ply", content).points, two);
  std::ranges::replace(content, '\n', '\r');
  EXPECT_EQ(read_content("a.ply", content).points, two);
  std::string body;
  for (const auto& point : two)
    body += bytes_of(std::int64_t{7}) + bytes_of(point.x()) + bytes_of(point.y()) + bytes_of(point.z());
  const std::string stamped =
      "element vertex 2\nproperty int64 t\nproperty double x\nproperty double y\nproperty double z\n";
  EXPECT_EQ(read_content("a.ply", ply("binary_little_endian", stamped, body)).points, two);
}

TEST(PlyReader, RefusalsSayWhatWouldHelp) {
  expect_unreadable("a.ply", ply("ascii", vertex(1), "1,2,3\n"), {"line 8", "replace the commas"});
  expect_unreadable("a.ply", ply("ascii", vertex(1) + vertex(1), "1 2 3\n1 2 3\n"),
                    {"2 'vertex'", "a file of its own"});
  expect_unreadable("a.ply", ply("ascii", "element vertex 1\nproperty float u\n", "1\n"), {"'x'", "it has u"});
}

}  // namespace
}  // namespace igsp::io
