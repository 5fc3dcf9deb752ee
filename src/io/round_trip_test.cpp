#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "io/io_testing.hpp"

namespace igsp {
namespace {

using io::testing::TemporaryFolder;

const std::vector<std::pair<FileFormat, std::string>> formats = {{FileFormat::ply_ascii, "cloud.ply"},
                                                                 {FileFormat::ply_binary_little_endian, "cloud.ply"},
                                                                 {FileFormat::ply_binary_big_endian, "cloud.ply"},
                                                                 {FileFormat::pcd_ascii, "cloud.pcd"},
                                                                 {FileFormat::pcd_binary, "cloud.pcd"},
                                                                 {FileFormat::pcd_binary_compressed, "cloud.pcd"},
                                                                 {FileFormat::text, "cloud.xyz"},
                                                                 {FileFormat::text, "cloud.txt"},
                                                                 {FileFormat::text, "cloud.csv"},
                                                                 {FileFormat::text, "cloud.pts"}};

/// Any finite double, by its bits: also denormals, -0.0 and the largest ones.
double any_finite() {
  const auto value = std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
  return std::isfinite(value) ? value : 0.0;
}

double any_float() {
  const auto value = std::bit_cast<float>(*rc::gen::arbitrary<std::uint32_t>());
  return std::isfinite(value) ? static_cast<double>(value) : -0.0;
}

Points any_points(double (*any_coordinate)()) {
  Points points(*rc::gen::inRange<std::size_t>(0, 40));
  for (Eigen::Vector3d& point : points) {
    for (double& value : point) value = any_coordinate();
  }
  return points;
}

void require_same_bits(const Points& read, const Points& written) {
  RC_ASSERT(read.size() == written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      RC_ASSERT(std::bit_cast<std::uint64_t>(read[i][axis]) == std::bit_cast<std::uint64_t>(written[i][axis]));
    }
  }
}

void check_round_trip(bool single_precision) {
  const TemporaryFolder folder;
  for (const auto& [format, name] : formats) {
    SCOPED_TRACE(name + " format " + std::to_string(static_cast<int>(format)));
    EXPECT_TRUE(rc::check([&, format = format, name = name] {
      const Points points = any_points(single_precision ? any_float : any_finite);
      std::filesystem::remove(folder / name);  // some file systems wait for the disk when a file is replaced
      write_points(folder / name, points, {.format = format, .single_precision = single_precision});
      const LoadedCloud cloud = read_points(folder / name);
      require_same_bits(cloud.points, points);
      RC_ASSERT(cloud.format == format);
      RC_ASSERT(cloud.dropped == 0u);
    }));
  }
}

TEST(RoundTrip, DoublesComeBackBitByBitInEveryFormat) {
  check_round_trip(false);
}

TEST(RoundTrip, FloatsComeBackBitByBitInEveryFormat) {
  check_round_trip(true);
}

TEST(RoundTrip, SinglePrecisionIsTheSameRoundingInEveryFormat) {
  const TemporaryFolder folder;
  const Points points = {{0.1, -1234567.891, 1e-12}};
  for (const auto& [format, name] : formats) {
    write_points(folder / name, points, {.format = format, .single_precision = true});
    const Points read = read_points(folder / name).points;
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(read[0], points[0].cast<float>().cast<double>()) << name;
  }
}

TEST(RoundTrip, SinglePrecisionHalvesBinaryFiles) {
  const TemporaryFolder folder;
  const Points points(1000, Eigen::Vector3d(1, 2, 3));
  write_points(folder / "double.ply", points);
  write_points(folder / "single.ply", points, {.format = {}, .single_precision = true});
  EXPECT_NEAR(static_cast<double>(file_size(folder / "double.ply") - file_size(folder / "single.ply")), 12000, 10);
}

/// The reader hands out the same points, in order, whatever the size of a chunk; only the last chunk is short.
TEST(RoundTrip, ChunkBoundariesLoseNothing) {
  const TemporaryFolder folder;
  Points points;
  for (int i = 0; i < 12; ++i) points.emplace_back(i, 0.1 * i, -i);
  for (const auto& [format, name] : formats) {
    write_points(folder / name, points, {.format = format});
    for (const std::size_t size : {1u, 5u, 6u, 11u, 12u, 13u}) {
      PointReader reader(folder / name, size);
      Points read;
      for (PointView chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
        EXPECT_EQ(chunk.size(), std::min(size, points.size() - read.size())) << name;
        read.insert(read.end(), chunk.begin(), chunk.end());
      }
      EXPECT_EQ(read, points) << name << " in chunks of " << size;
      EXPECT_TRUE(reader.next_chunk().empty()) << "the end stays the end";
    }
  }
}

/// 100,000 points are several buffers of the reader and two default chunks.
TEST(RoundTrip, FilesLargerThanTheBuffer) {
  const TemporaryFolder folder;
  Points points;
  for (int i = 0; i < 100000; ++i) points.emplace_back(i * 0.001, 5e6 + i / 7.0, std::sin(i));
  for (const auto& [format, name] : formats) {
    std::filesystem::remove(folder / name);
    write_points(folder / name, points, {.format = format});
    EXPECT_EQ(read_points(folder / name).points, points) << name;
  }
  PointReader reader(folder / "cloud.ply");
  EXPECT_EQ(reader.declared_points(), 100000u);
  EXPECT_EQ(reader.next_chunk().size(), PointReader::default_chunk);
}

TEST(RoundTrip, AnEmptyCloudIsAFileToo) {
  const TemporaryFolder folder;
  for (const auto& [format, name] : formats) {
    write_points(folder / name, Points(), {.format = format});
    EXPECT_TRUE(read_points(folder / name).points.empty()) << name;
  }
}

TEST(RoundTrip, TheFormatIsThatOfTheExtensionByDefault) {
  const TemporaryFolder folder;
  const Points points = {{1, 2, 3}};
  for (const auto& [name, format] :
       std::vector<std::pair<std::string, FileFormat>>{{"a.ply", FileFormat::ply_binary_little_endian},
                                                       {"a.PCD", FileFormat::pcd_binary},
                                                       {"a.Xyz", FileFormat::text}}) {
    EXPECT_EQ(format_of(name), format);
    write_points(folder / name, points);
    EXPECT_EQ(read_points(folder / name).format, format) << name;
  }
  EXPECT_EQ(format_of("a.Las"), FileFormat::las);
  io::testing::expect_file_error([] { format_of("scan.e57"); }, {"scan.e57", ".ply"});
  io::testing::expect_file_error([&] { write_points(folder / "scan", points); }, {"scan"});
}

TEST(RoundTrip, ContentGoesBeforeExtension) {
  const TemporaryFolder folder;
  const Points points = {{1, 2, 3}, {4, 5, 6}};
  for (const auto& [format, ignored] : formats) {
    if (format == FileFormat::text) continue;
    write_points(folder / "cloud.txt", points, {.format = format});
    EXPECT_EQ(read_points(folder / "cloud.txt").format, format);
    EXPECT_EQ(read_points(folder / "cloud.txt").points, points);
  }
}

}  // namespace
}  // namespace igsp
