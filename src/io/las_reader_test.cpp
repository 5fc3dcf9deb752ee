#include <gtest/gtest.h>

#include <limits>

#include "io/las_testing.hpp"

namespace igsp::io {
namespace {

using testing::las_of_format;
using testing::LasFile;
using testing::read_content;
using testing::TemporaryFolder;

TEST(LasReader, EveryPointFormat) {
  for (int format = 0; format <= 10; ++format) {
    const LasFile file = las_of_format(format);
    const LoadedCloud cloud = read_content("a.las", file.bytes());
    EXPECT_EQ(cloud.format, FileFormat::las);
    EXPECT_EQ(cloud.noise, 0u);
    EXPECT_FALSE(cloud.viewpoint);
    ASSERT_EQ(cloud.points.size(), file.stored.size()) << format;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) EXPECT_EQ(cloud.points[i], file.point(i)) << format;
  }
}

TEST(LasReader, EveryVersion) {
  for (int minor = 0; minor <= 4; ++minor) {
    LasFile file = las_of_format(1);
    file.minor = minor;
    EXPECT_EQ(read_content("a.las", file.bytes()).points.size(), 100u) << minor;
  }
}

TEST(LasReader, TheContentDecidesNotTheName) {
  EXPECT_EQ(read_content("a.ply", las_of_format(1).bytes()).points.size(), 100u);
  EXPECT_EQ(read_content("A.LAS", las_of_format(1).bytes()).points.size(), 100u);
}

TEST(LasReader, NoiseAndWithheldPointsAreLeftOutUnlessAskedFor) {
  for (const int format : {0, 3, 5, 6, 10}) {
    LasFile file = las_of_format(format);
    file.noise = {0, 1, 2, 50};
    file.withheld = {2, 3, 99};
    const TemporaryFolder folder;
    const auto path = folder.write("a.las", file.bytes());
    const LoadedCloud cloud = read_points(path);
    EXPECT_EQ(cloud.noise, 6u) << format;
    ASSERT_EQ(cloud.points.size(), 94u) << format;
    EXPECT_EQ(cloud.points.front(), file.point(4));
    EXPECT_EQ(cloud.points.back(), file.point(98));
    ReadOptions all;
    all.keep_noise = true;
    EXPECT_EQ(read_points(path, all).points.size(), 100u);
    EXPECT_EQ(read_points(path, all).noise, 0u);
  }
}

TEST(LasReader, ChunksOfAnySizeGiveTheSamePoints) {
  LasFile file = las_of_format(7);
  file.noise = {3, 4, 5, 6, 7, 8, 9};  // more than a chunk of nothing
  const TemporaryFolder folder;
  const auto path = folder.write("a.las", file.bytes());
  const Points whole = read_points(path).points;
  for (const std::size_t size : {1, 3, 93, 1000}) {
    PointReader reader(path, size);
    Points points;
    for (PointView chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
      EXPECT_LE(chunk.size(), size);
      points.insert(points.end(), chunk.begin(), chunk.end());
    }
    EXPECT_EQ(points, whole) << size;
    EXPECT_EQ(reader.noise(), 7u);
    EXPECT_EQ(reader.declared_points(), 100u);
  }
}

TEST(LasReader, NoPoints) {
  LasFile file = las_of_format(6);
  file.stored.clear();
  EXPECT_TRUE(read_content("a.las", file.bytes()).points.empty());
}

/// A good file with some bytes changed.
std::string changed(const LasFile& file, std::size_t at, const std::string& now) {
  return file.bytes().replace(at, now.size(), now);
}

void expect_refused(const std::string& content, std::initializer_list<std::string> parts) {
  testing::expect_unreadable("a.las", content, parts);
}

TEST(LasReader, CompressedPointsAreToldWhereTheyAreRead) {
  const std::string laz = changed(las_of_format(1), 104, "\x81");
  expect_refused(laz, {"a.las: compressed LAS (LAZ): use the Python package, pip install 'igsp[las]'"});
  testing::expect_unreadable("a.laz", laz, {"compressed LAS (LAZ): use the Python package"});
  testing::expect_unreadable("a.laz", "what is this", {"compressed LAS (LAZ): use the Python package"});
  const TemporaryFolder folder;
  EXPECT_TRUE(is_compressed_las(folder.write("a.las", laz)));
  EXPECT_FALSE(is_compressed_las(folder.write("b.las", las_of_format(1).bytes())));
  EXPECT_FALSE(is_compressed_las(folder.write("c.las", "LASF")));
  EXPECT_FALSE(is_compressed_las(folder / "nowhere.las"));
}

TEST(LasReader, HeadersThatMakeNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const LasFile file = las_of_format(1), new_file = las_of_format(6);
  expect_refused("LASX" + std::string(300, '\0'), {"byte offset 0: not a LAS file: it does not begin with LASF"});
  expect_refused("LASF", {"byte offset 4: the file ends within its header"});
  expect_refused(changed(file, 25, "\x04"), {"byte offset 94: a header of 227 bytes; LAS 1.4 has 375"});
  expect_refused(changed(file, 104, "\x0B"), {"byte offset 104: point format 11; LAS has 0 to 10"});
  expect_refused(changed(file, 105, testing::bytes_of(std::uint16_t{12})),
                 {"byte offset 105: points of 12 bytes; point format 1 has at least 28"});
  expect_refused(changed(file, 105, testing::bytes_of(std::uint16_t{0})), {"points of 0 bytes"});
  for (const double scale : {0.0, -0.01, nan, infinite, 1e300}) {
    expect_refused(changed(file, 139, testing::bytes_of(scale)), {"byte offset 131: scale 0.001 ", "no coordinates"});
  }
  for (const double offset : {nan, infinite, -1e300}) {
    expect_refused(changed(file, 155, testing::bytes_of(offset)), {"byte offset 131: scale", "offset"});
  }
  expect_refused(changed(file, 96, testing::bytes_of(std::uint32_t{100})), {"byte offset 96", "begin at byte 100"});
  expect_refused(changed(file, 96, testing::bytes_of(std::uint32_t{1u << 31})), {"begin at byte 2147483648"});
  expect_refused(changed(file, 94, testing::bytes_of(std::uint16_t{65535})), {"truncated"});
  expect_refused(changed(new_file, 235, testing::bytes_of(std::uint64_t{1} << 62)), {"extended", "record 0"});
}

TEST(LasReader, CountsLargerThanTheFile) {
  const LasFile file = las_of_format(1), new_file = las_of_format(6);
  expect_refused(changed(file, 107, testing::bytes_of(0xFFFFFFFFu)), {"declares 4294967295 points", "bytes follow"});
  expect_refused(changed(new_file, 247, testing::bytes_of(~std::uint64_t{0})),
                 {"declares 18446744073709551615 points"});
  expect_refused(changed(file, 105, testing::bytes_of(std::uint16_t{65535})),
                 {"declares 100 points of at least 65535"});
  expect_refused(changed(file, 100, testing::bytes_of(0xFFFFFFFFu)), {"points begin before variable length record 1"});
  expect_refused(changed(file, 227 + 20, testing::bytes_of(std::uint16_t{65535})),
                 {"variable length record 0, at byte"});
  expect_refused(changed(new_file, 243, testing::bytes_of(0xFFFFFFFFu)), {"before extended variable length record 1"});
  expect_refused(changed(new_file, new_file.bytes().size() - 340, testing::bytes_of(~std::uint64_t{0})),
                 {"before extended variable length record 0"});
}

TEST(LasReader, CutAnywhere) {
  for (const int format : {1, 6}) {
    LasFile file = las_of_format(format);
    if (format == 1) file.behind.clear();
    const std::string content = file.bytes();
    for (std::size_t size = 1; size < content.size(); size += 83) {
      testing::expect_unreadable("a.las", content.substr(0, size), {"a.las"});
    }
    expect_refused(content.substr(0, content.size() - 1), {format == 1 ? "bytes follow" : "extended"});
  }
}

}  // namespace
}  // namespace igsp::io
