#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "io/las_testing.hpp"
#include "io/moved_copy.hpp"

namespace igsp::io {
namespace {

using testing::bytes_of;
using testing::las_of_format;
using testing::LasFile;
using testing::read_bytes;
using testing::TemporaryFolder;

Transformation motion_about(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& translation) {
  Transformation motion = Transformation::Identity();
  motion.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  motion.translation() = translation;
  return motion;
}

const Transformation tilted = motion_about({0.2, -0.3, 0.9}, 0.7, {1250.25, -310.5, 12.125});

struct Moved {
  std::string bytes;
  Points points;
};

Moved moved(const std::string& source, const Transformation& motion) {
  const TemporaryFolder folder;
  const auto from = folder.write("a.las", source), to = folder / "b.las";
  EXPECT_FALSE(write_moved(from, to, motion));
  EXPECT_EQ(folder.files(), 2u);
  ReadOptions all;
  all.keep_noise = true;
  return {read_bytes(to), read_points(to, all).points};
}

Eigen::Vector3d numbers_at(const std::string& bytes, std::size_t at, std::size_t step = 8) {
  return {las_number<double>(&bytes[at]), las_number<double>(&bytes[at + step]),
          las_number<double>(&bytes[at + 2 * step])};
}

void expect_moved_within(const Moved& result, const LasFile& source, const Transformation& motion, double tolerance) {
  ASSERT_EQ(result.points.size(), source.stored.size());
  Eigen::Vector3d lowest = result.points.front(), highest = lowest;
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    EXPECT_LT((result.points[i] - motion * source.point(i)).cwiseAbs().maxCoeff(), tolerance);
    lowest = lowest.cwiseMin(result.points[i]);
    highest = highest.cwiseMax(result.points[i]);
  }
  EXPECT_EQ(numbers_at(result.bytes, 179, 16), highest);
  EXPECT_EQ(numbers_at(result.bytes, 187, 16), lowest);
}

TEST(LasMoved, EveryPointFormatKeepsAllThatDoesNotMove) {
  for (int format = 0; format <= 10; ++format) {
    LasFile file = las_of_format(format);
    file.noise = {1, 2};
    std::string before = file.bytes();
    Moved result = moved(before, tilted);
    EXPECT_EQ(numbers_at(result.bytes, 131), Eigen::Vector3d::Constant(0.001)) << "the finest that contributes";
    expect_moved_within(result, file, tilted, 0.5001e-3 + 2e-9);
    ASSERT_EQ(result.bytes.size(), before.size());
    const std::size_t pulse = std::map<int, std::size_t>{{4, 45}, {5, 51}, {9, 47}, {10, 55}}[format];
    for (std::string* bytes : {&before, &result.bytes}) {
      bytes->replace(131, 96, 96, '\0');
      for (std::size_t i = 0; i < file.stored.size(); ++i) {
        const std::size_t start = file.points_start() + i * file.record_length();
        bytes->replace(start, 12, 12, '\0');
        if (pulse > 0) bytes->replace(start + pulse, 12, 12, '\0');
      }
    }
    EXPECT_TRUE(before == result.bytes) << format;
  }
}

TEST(LasMoved, DirectionOfTheWaveformTurns) {
  LasFile file = las_of_format(4);
  file.stored.resize(1);
  std::string source = file.bytes();
  const std::size_t pulse = file.points_start() + 28 + 17;
  source.replace(pulse, 12, bytes_of(1.0f) + bytes_of(2.0f) + bytes_of(-4.0f));
  const std::string result = moved(source, motion_about({0, 0, 1}, std::numbers::pi / 2, {1, 2, 3})).bytes;
  EXPECT_FLOAT_EQ(las_number<float>(&result[pulse]), -2);
  EXPECT_FLOAT_EQ(las_number<float>(&result[pulse + 4]), 1);
  EXPECT_FLOAT_EQ(las_number<float>(&result[pulse + 8]), -4);
}

TEST(LasMoved, TranslationChangesNoInteger) {
  const LasFile file = las_of_format(3);
  const Moved result = moved(file.bytes(), motion_about({0, 0, 1}, 0, {0.12345678, -1e6, 3.3}));
  EXPECT_EQ(numbers_at(result.bytes, 131), file.scale);
  EXPECT_EQ(numbers_at(result.bytes, 155), file.offset + Eigen::Vector3d(0.12345678, -1e6, 3.3));
  const std::size_t start = file.points_start();
  EXPECT_EQ(result.bytes.substr(start), file.bytes().substr(start));
}

TEST(LasMoved, ScalesMixWhereAxesDo) {
  const LasFile file = las_of_format(0);
  const Moved level = moved(file.bytes(), motion_about({0, 0, 1}, 0.3, Eigen::Vector3d::Zero()));
  EXPECT_EQ(numbers_at(level.bytes, 131), Eigen::Vector3d(0.001, 0.001, 0.004));
}

TEST(LasMoved, AFactorOfScaleKeepsTheIntegersFine) {
  LasFile file = las_of_format(4);
  Transformation to_metres = motion_about({0, 0, 1}, 0, {5, 6, 7});
  to_metres.linear() *= 0.001;
  std::string source = file.bytes();
  const std::size_t pulse = file.points_start() + 28 + 17;
  source.replace(pulse, 12, bytes_of(1000.0f) + bytes_of(0.0f) + bytes_of(0.0f));
  const Moved result = moved(source, to_metres);
  EXPECT_LT((numbers_at(result.bytes, 131) - 0.001 * file.scale).cwiseAbs().maxCoeff(), 1e-15);
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    EXPECT_LT((result.points[i] - to_metres * file.point(i)).norm(), 1e-8);
  }
  EXPECT_FLOAT_EQ(las_number<float>(&result.bytes[pulse]), 1.0f) << "length a picosecond";
}

/// With the source's offset the integers would not fit into 32 bits.
TEST(LasMoved, FarFromItsOffset) {
  LasFile file = las_of_format(1);
  file.scale = Eigen::Vector3d::Constant(1e-5);
  for (auto& stored : file.stored) stored = {stored[0] + 2'000'000'000, stored[1] + 2'000'000'000, stored[2]};
  const Transformation motion = motion_about({0, 0, 1}, std::numbers::pi / 4, {691000, 5334000, 0});
  const Moved result = moved(file.bytes(), motion);
  EXPECT_EQ(numbers_at(result.bytes, 131), file.scale);
  expect_moved_within(result, file, motion, 0.51e-5);
}

/// The corners of a cube that fills the range: turned, they need a coarser scale.
TEST(LasMoved, RangeOf32BitsLeftByTurning) {
  LasFile file;
  file.scale = Eigen::Vector3d::Constant(1e-7);
  file.offset.setZero();
  const std::int32_t lowest = std::numeric_limits<std::int32_t>::min(), highest = -(lowest + 1);
  for (int i = 0; i < 8; ++i) {
    file.stored.push_back({i & 1 ? highest : lowest, i & 2 ? highest : lowest, i & 4 ? highest : lowest});
  }
  const Transformation motion = motion_about({0.2, -0.3, 0.9}, 0.7, Eigen::Vector3d::Zero());
  const Moved result = moved(file.bytes(), motion);
  EXPECT_GT(numbers_at(result.bytes, 131).maxCoeff(), 0.9e-6);
  expect_moved_within(result, file, motion, 0.51e-6);
  expect_moved_within(moved(file.bytes(), Transformation::Identity()), file, Transformation::Identity(), 1e-6);
}

TEST(LasMoved, NoPoints) {
  LasFile file = las_of_format(6);
  file.stored.clear();
  const Moved result = moved(file.bytes(), tilted);
  EXPECT_TRUE(result.points.empty());
  EXPECT_EQ(numbers_at(result.bytes, 179), Eigen::Vector3d::Zero());
}

TEST(LasMoved, WhatIsRefusedLeavesNothing) {
  const TemporaryFolder folder;
  const auto source = folder.write("a.las", las_of_format(1).bytes());
  Transformation away = Transformation::Identity();
  away.translation().x() = 1e300;
  testing::expect_file_error([&] { write_moved(source, folder / "b.las", away); }, {"a.las: moved", "offset 1e+300"});
  const MoveOptions cancelled{.read = {}, .doubles = false, .progress = [](const Progress&) { return false; }};
  EXPECT_THROW(write_moved(source, folder / "b.las", tilted, cancelled), Cancelled);
  const std::string content = las_of_format(6).bytes();
  for (std::size_t size = 1; size < content.size(); size += 83) {
    const auto cut = folder.write("cut.las", content.substr(0, size));
    EXPECT_THROW(write_moved(cut, folder / "b.las", tilted), FileError) << size;
  }
  EXPECT_EQ(folder.files(), 2u);
}

TEST(LasMoved, PointsAloneAreNotWritten) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_points(folder / "a.las", Points{{1, 2, 3}}), InvalidArgument);
  EXPECT_EQ(folder.files(), 0u);
}

/// More than one buffer, whose borders lie within records; the same file may be source and destination.
TEST(LasMoved, FilesLargerThanTheBuffer) {
  LasFile file = las_of_format(3);
  file.stored.clear();
  for (int i = 0; i < 40000; ++i) file.stored.push_back({i, 3 * i, -i});
  file.withheld = {};
  const TemporaryFolder folder;
  const auto path = folder.write("a.las", file.bytes());
  const Transformation quarter = motion_about({0, 0, 1}, std::numbers::pi / 2, {10, 20, 30});
  write_moved(path, path, quarter);
  const Points points = read_points(path).points;
  ASSERT_EQ(points.size(), file.stored.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_LT((points[i] - quarter * file.point(i)).cwiseAbs().maxCoeff(), 1e-3) << i;
  }
}

}  // namespace
}  // namespace igsp::io
