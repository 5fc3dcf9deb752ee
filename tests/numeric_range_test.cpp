// Whatever the unit of length: from 1e-140 to 1e140 a pair is registered as at 1, and what no computer can hold is
// refused with the numeric cause.
#include <gtest/gtest.h>

#include <string>

#include "igsp/errors.hpp"
#include "scenes.hpp"

namespace igsp {
namespace {

using testing::disagreement;
using testing::Pair;

Points scaled(PointView points, double factor) {
  Points all(points.begin(), points.end());
  for (Eigen::Vector3d& point : all) point *= factor;
  return all;
}

Pair pair() {
  return testing::scrambled(testing::simulated_pair("object", 8000), 1);
}

class AnyUnit : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Factors, AnyUnit,
                         ::testing::Values(1e-140, 1e-40, 1e-20, 1e-10, 1e-6, 1e-3, 1e3, 1e6, 1e14, 1e40, 1e140));

TEST_P(AnyUnit, RegistersAsInMetres) {
  const Pair clouds = pair();
  const Result metres = align(clouds.source, clouds.target);
  ASSERT_TRUE(metres.registered) << metres.reason;
  Result result = align(scaled(clouds.source, GetParam()), scaled(clouds.target, GetParam()));
  EXPECT_TRUE(result.registered) << result.reason;
  EXPECT_NEAR(result.voxel_size / GetParam(), metres.voxel_size, 1e-9 * metres.voxel_size);
  EXPECT_NEAR(result.rmse / GetParam(), metres.rmse, 1e-3 * metres.voxel_size);
  EXPECT_NEAR(result.precision.covariance(5, 5) / GetParam() / GetParam(), metres.precision.covariance(5, 5),
              0.02 * metres.precision.covariance(5, 5));
  result.target_from_source.translation() /= GetParam();
  EXPECT_LT(disagreement(result.target_from_source, metres.target_from_source, clouds.source),
            1e-3 * metres.voxel_size);
}

TEST(NumericRange, ExactForPowersOfTwo) {
  const Pair clouds = pair();
  const Result one = align(clouds.source, clouds.target);
  const double factor = 0x1p-60;
  const Result tiny = align(scaled(clouds.source, factor), scaled(clouds.target, factor));
  EXPECT_EQ(tiny.voxel_size, factor * one.voxel_size);
  EXPECT_EQ(tiny.options.scale.voxel_size, factor * one.options.scale.voxel_size);
  EXPECT_EQ(tiny.rmse, factor * one.rmse);
  EXPECT_EQ(tiny.confidence, one.confidence);
  EXPECT_EQ(tiny.reason, one.reason);
  EXPECT_EQ(tiny.target_from_source.translation(), factor * one.target_from_source.translation());
  EXPECT_EQ(tiny.target_from_source.linear(), one.target_from_source.linear());
  EXPECT_EQ(tiny.precision.centre, factor * one.precision.centre);
  EXPECT_EQ(tiny.precision.information(0, 0), one.precision.information(0, 0));
  EXPECT_EQ(factor * tiny.precision.information(0, 4), one.precision.information(0, 4));
  EXPECT_EQ(factor * factor * tiny.precision.information(4, 5), one.precision.information(4, 5));
  EXPECT_EQ(tiny.source_keypoints, scaled(one.source_keypoints, factor));
  EXPECT_EQ(tiny.iterations.back().translation_step, factor * one.iterations.back().translation_step);
}

TEST(NumericRange, TheStagedDoorAnswersTheSame) {
  const Pair clouds = pair();
  const double factor = 0x1p-60;
  const Points source = scaled(clouds.source, factor), target = scaled(clouds.target, factor);
  Options options;
  options.scale.voxel_size = align(source, target).voxel_size;
  const Features source_features = extract_features(source, options),
                 target_features = extract_features(target, options);
  EXPECT_EQ(source_features.voxel_size, options.scale.voxel_size);
  EXPECT_EQ(align(source_features, target_features, options).target_from_source.matrix(),
            align(source, target, options).target_from_source.matrix());
}

TEST(NumericRange, AnythingElseIsAnAnswerOrARefusal) {
  const Pair clouds = pair();
  Options huge_voxels, tiny_voxels;
  huge_voxels.scale.voxel_size = 1e39;
  tiny_voxels.scale.voxel_size = 1e-39;
  EXPECT_FALSE(align(clouds.source, clouds.target, huge_voxels).registered);
  EXPECT_THROW(align(clouds.source, clouds.target, tiny_voxels), InvalidArgument);
  for (const double distance : {1e30, 1e50, 1e300}) {
    Transformation far = Transformation::Identity();
    far.translation() = Eigen::Vector3d(distance, -distance, 0);
    EXPECT_FALSE(align(clouds.source, clouds.target, far).registered);
    const Points tiny = scaled(clouds.source, 1e-40);
    if (distance < 1e299) EXPECT_FALSE(align(tiny, tiny, far).registered);
  }
  EXPECT_FALSE(align(scaled(clouds.source, 1e-60), scaled(clouds.target, 1e60)).registered);
  const Points lone = {{5, 5, 5}};
  Options least_voxel;
  least_voxel.scale.voxel_size = 1e-320;
  EXPECT_FALSE(align(lone, lone, least_voxel).registered);
}

TEST(NumericRange, WhatCannotBeHeldIsNamed) {
  const Pair clouds = pair();
  const auto message = [&](double source_factor, double voxel_size) -> std::string {
    Options options;
    options.scale.voxel_size = voxel_size;
    try {
      align(scaled(clouds.source, source_factor), clouds.target, options);
    } catch (const InvalidArgument& error) {
      return error.what();
    }
    return "no refusal";
  };
  EXPECT_NE(message(1e155, 0).find("in magnitude; at most 1e+150"), std::string::npos) << message(1e155, 0);
  EXPECT_NE(message(1e-155, 0).find("at least 1e-150"), std::string::npos) << message(1e-155, 0);
  EXPECT_NE(message(1, 1e-39).find("voxel_size is 1e-39"), std::string::npos) << message(1, 1e-39);
  EXPECT_NE(message(1, 1e200).find("voxel_size"), std::string::npos) << message(1, 1e200);
}

}  // namespace
}  // namespace igsp
