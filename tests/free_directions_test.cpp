// Surfaces that slide along themselves: the answer is a refusal that names every such motion, checked against the
// scene.
#include <gtest/gtest.h>

#include <Eigen/QR>

#include "igsp/features.hpp"
#include "scenes.hpp"

namespace igsp {
namespace {

using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Motions = std::vector<Vector6>;  // (rotation, translation), as FreeDirection has them

constexpr double same_direction = 0.93;  // cosine

/// A scan pair, and where the scene's origin and axes are in the target's frame.
struct Scene {
  testing::Pair pair;
  Transformation target_from_world;
};

Scene make_scene(std::string_view name, std::uint64_t seed) {
  SimulationOptions options;
  options.points = 20000;
  options.seed = seed;
  std::vector<SimulatedScan> scans = simulate(name, options);
  const Transformation target_from_world = scans[1].world_from_scanner.inverse();
  testing::Pair pair{std::move(scans[0].points), std::move(scans[1].points),
                     target_from_world * scans[0].world_from_scanner};
  return {testing::scrambled(std::move(pair), seed), target_from_world};
}

/// The length by which FreeDirection scales rotations: the size of the cloud that is moved, or of the target alone.
double scale_of(const Result& result, const testing::Pair& pair) {
  Options options;
  options.scale.voxel_size = result.voxel_size;
  return testing::radius_of_gyration(extract_features(result.has_estimate ? pair.source : pair.target, options).points);
}

Vector6 translation_along(const Vector3d& axis) {
  Vector6 motion = Vector6::Zero();
  motion.tail<3>() = axis.normalized();
  return motion;
}

/// About the axis through `place`, written as a motion about `centre`.
Vector6 rotation_about(const Vector3d& axis, const Vector3d& place, const Vector3d& centre, double scale) {
  Vector6 motion;
  motion << scale * axis.normalized(), axis.normalized().cross(centre - place);
  return motion.normalized();
}

double share_within(const Motions& motions, const Vector6& direction) {
  if (motions.empty()) return 0.0;
  Eigen::MatrixXd columns(6, motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) columns.col(i) = motions[i];
  const Eigen::VectorXd coefficients = columns.colPivHouseholderQr().solve(direction);
  return (columns * coefficients).norm() / direction.norm();
}

/// Refused; all of `free` is named, and nothing beyond it and what `may_be_free`.
void expect_named(const Result& result, const Motions& free, const Motions& may_be_free = {}) {
  EXPECT_FALSE(result.registered) << result.confidence << ": " << result.reason;
  Motions named, allowed = free;
  allowed.insert(allowed.end(), may_be_free.begin(), may_be_free.end());
  for (const FreeDirection& direction : result.precision.free_directions) {
    named.push_back(direction.motion);
    EXPECT_NE(result.reason.find(direction.description), std::string::npos) << result.reason;
    EXPECT_GT(share_within(allowed, direction.motion), same_direction) << direction.description << " is not free";
  }
  for (const Vector6& motion : free)
    EXPECT_GT(share_within(named, motion), same_direction) << motion.transpose() << " is free: " << result.reason;
}

class FreeDirections : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, FreeDirections, ::testing::Range<std::uint64_t>(1, 7));

TEST_P(FreeDirections, Corridor) {
  const Scene scene = make_scene("corridor", GetParam());
  const Result result = align(scene.pair.source, scene.pair.target);
  expect_named(result, {translation_along(scene.target_from_world.linear() * Vector3d::UnitX())});
}

TEST_P(FreeDirections, OfTheExchangedCorridorInTheOtherFrame) {
  const Scene scene = make_scene("corridor", GetParam());
  const Result result = align(scene.pair.target, scene.pair.source);
  const Eigen::Matrix3d source_from_world = scene.pair.truth.linear().transpose() * scene.target_from_world.linear();
  expect_named(result, {translation_along(source_from_world * Vector3d::UnitX())});
}

TEST_P(FreeDirections, Sphere) {
  const Scene scene = make_scene("sphere", GetParam());
  const Result result = align(scene.pair.source, scene.pair.target);
  const double scale = scale_of(result, scene.pair);
  Motions rotations;
  for (int i = 0; i < 3; ++i)
    rotations.push_back(
        rotation_about(Vector3d::Unit(i), scene.target_from_world.translation(), result.precision.centre, scale));
  expect_named(result, rotations);
}

TEST_P(FreeDirections, Plane) {
  const Scene scene = make_scene("plane", GetParam());
  const Result result = align(scene.pair.source, scene.pair.target);
  const double scale = scale_of(result, scene.pair);
  const Eigen::Matrix3d axes = scene.target_from_world.linear();
  expect_named(result,
               {translation_along(axes.col(0)), translation_along(axes.col(1)),
                rotation_about(axes.col(2), scene.target_from_world.translation(), result.precision.centre, scale)});
}

TEST_P(FreeDirections, Cylinder) {
  const Scene scene = make_scene("cylinder", GetParam());
  const Result result = align(scene.pair.source, scene.pair.target);
  const double scale = scale_of(result, scene.pair);
  const Vector3d axis = scene.target_from_world.linear().col(2);
  // Where no cap is in sight, nothing holds the cylinder along its axis either.
  expect_named(result, {rotation_about(axis, scene.target_from_world.translation(), result.precision.centre, scale)},
               {translation_along(axis)});
}

// Few voxels across the body: what looks like a hold is the unevenness of the voxels.
class SparseFreeDirections : public ::testing::TestWithParam<std::tuple<std::string, int>> {};
INSTANTIATE_TEST_SUITE_P(Scenes, SparseFreeDirections,
                         ::testing::Combine(::testing::Values<std::string>("plane", "sphere", "cylinder", "corridor"),
                                            ::testing::Values(500, 1000, 3000, 8000)));

TEST_P(SparseFreeDirections, StayRefused) {
  const auto [scene, points] = GetParam();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const testing::Pair pair = testing::simulated_pair(scene, points, 0, seed);
    const Result result = align(pair.source, pair.target);
    EXPECT_FALSE(result.registered) << "seed " << seed << ": " << result.confidence << ": " << result.reason;
  }
}

}  // namespace
}  // namespace igsp
