// From an initial guess, and with four degrees of freedom.
#include <gtest/gtest.h>

#include "scenes.hpp"
#include "simulation/random.hpp"

namespace igsp {
namespace {

using simulation::Random;
using testing::disagreement;
using testing::Pair;

constexpr double degree = EIGEN_PI / 180.0;
constexpr double right = 0.4;  // [voxels]; seen up to 0.35 in the park, whose trees are hollow clumps

/// The truth turned about the source's centroid, and shifted.
Transformation displaced(const Pair& pair, double angle_rad, double shift, Random& random) {
  const Eigen::Vector3d centroid = pair.truth * testing::centroid(pair.source);
  Transformation motion(Eigen::AngleAxisd(angle_rad, random.direction()));
  motion.translation() = centroid + shift * random.direction() - motion.linear() * centroid;
  return motion * pair.truth;
}

class InitialGuess : public ::testing::TestWithParam<const char*> {
 protected:
  static constexpr std::uint64_t seeds = 3;
  Pair pair(std::uint64_t seed) const {
    return testing::scrambled(testing::simulated_pair(GetParam(), 40000, 0.0, seed), seed);
  }
};
INSTANTIATE_TEST_SUITE_P(Scenes, InitialGuess, ::testing::Values("park", "indoor", "object"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(InitialGuess, GoodOneIsRefinedToTheTruth) {
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    const Pair clouds = pair(seed);
    const double voxel_size = align(clouds.source, clouds.target, clouds.truth).voxel_size;
    Random random(seed);
    const Transformation guess = displaced(clouds, 2.0 * degree, 2.0 * voxel_size, random);
    const Result result = align(clouds.source, clouds.target, guess);
    EXPECT_TRUE(result.registered) << result.reason;
    EXPECT_LT(disagreement(result.target_from_source, clouds.truth, clouds.source), right * voxel_size);
  }
}

TEST_P(InitialGuess, WrongOneIsNotBelieved) {
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Pair clouds = pair(seed);
    const double size = testing::radius_of_gyration(clouds.source);
    Random random(seed);
    for (const auto& [angle, shift] : {std::pair{90.0, 0.0}, {180.0, 0.0}, {0.0, 1.0}}) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", " << angle << " degrees, shift " << shift);
      const Transformation guess = displaced(clouds, angle * degree, shift * size, random);
      const Result result = align(clouds.source, clouds.target, guess);
      EXPECT_FALSE(result.registered) << result.confidence << ": " << result.reason;
    }
  }
}

class Levelled : public ::testing::TestWithParam<const char*> {
 protected:
  static constexpr std::uint64_t seeds = 3;
  /// Levelled scans, the source turned about the vertical and shifted.
  Pair pair(std::uint64_t seed) const {
    const Pair scans = testing::simulated_pair(GetParam(), 40000, 0.0, seed);
    Transformation away(Eigen::AngleAxisd(2.1 * static_cast<double>(seed), Eigen::Vector3d::UnitZ()));
    away.translation() << 30.0, -20.0, 5.0;
    return {testing::moved(away, scans.source), scans.target, scans.truth * away.inverse()};
  }
  Options options(int degrees_of_freedom) const {
    Options options = preset("default");
    options.degrees_of_freedom = degrees_of_freedom;
    return options;
  }
};
INSTANTIATE_TEST_SUITE_P(Scenes, Levelled, ::testing::Values("park", "indoor"),
                         [](const auto& info) { return std::string(info.param); });

void expect_level(const Transformation& transformation) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  EXPECT_EQ(transformation.linear() * up, up) << transformation.matrix();
  EXPECT_EQ(transformation.linear().transpose() * up, up) << transformation.matrix();
}

TEST_P(Levelled, FourDegreesOfFreedomKeepTheTilt) {
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    const Pair clouds = pair(seed);
    const Result result = align(clouds.source, clouds.target, options(4));
    EXPECT_TRUE(result.registered) << result.reason;
    EXPECT_LT(disagreement(result.target_from_source, clouds.truth, clouds.source), right * result.voxel_size);
    expect_level(result.target_from_source);
    for (const IterationRecord& iteration : result.iterations) expect_level(iteration.target_from_source);
    if (result.runner_up) expect_level(result.runner_up->target_from_source);
  }
}

TEST_P(Levelled, SixDegreesOfFreedomFindTheSame) {
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    const Pair clouds = pair(seed);
    const Result result = align(clouds.source, clouds.target, options(6));
    EXPECT_TRUE(result.registered) << result.reason;
    EXPECT_LT(disagreement(result.target_from_source, clouds.truth, clouds.source), right * result.voxel_size);
  }
}

}  // namespace
}  // namespace igsp
