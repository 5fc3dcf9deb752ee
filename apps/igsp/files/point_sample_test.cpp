#include "files/point_sample.hpp"

#include <gtest/gtest.h>

#include "core/core_testing.hpp"

namespace igsp::cli {
namespace {

Points random_points(std::size_t count) {
  testing::Random random(1);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
  }
  return points;
}

Points sample_of(PointView points, std::size_t limit, std::size_t expected) {
  PointSample sample(limit, expected);
  for (std::size_t i = 0; i < points.size(); i += 1000) {
    sample.add(points.subspan(i, std::min<std::size_t>(1000, points.size() - i)));
  }
  return sample.take();
}

TEST(PointSample, KeepsAllUpToItsLimit) {
  const Points points = random_points(5000);
  EXPECT_EQ(sample_of(points, 5000, 0), points);
  EXPECT_EQ(sample_of(points, 5000, 5000), points);
  EXPECT_EQ(sample_of(points, 5000, 20), points) << "the file may say what it wants";
}

TEST(PointSample, OfMoreIsTheSameHoweverManyWereExpected) {
  const Points points = random_points(20000);
  const Points unexpected = sample_of(points, 5000, 0);
  EXPECT_LE(unexpected.size(), 2500u);
  EXPECT_GT(unexpected.size(), 600u);
  EXPECT_EQ(sample_of(points, 5000, 20000), unexpected);
  EXPECT_EQ(sample_of(points, 5000, 1u << 30), unexpected);
  const Points backwards(points.rbegin(), points.rend());
  EXPECT_EQ(sample_of(backwards, 5000, 0), unexpected);
}

TEST(PointSample, IsAMillionPointsAtMost) {
  const Points points = random_points(2'100'000);
  const Points sample = sample_of(points, 2'050'000, points.size());
  EXPECT_LE(sample.size(), 1'000'000u);
  EXPECT_GT(sample.size(), 500'000u);
  EXPECT_EQ(sample_of(points, 2'050'000, 0), sample);
}

}  // namespace
}  // namespace igsp::cli
