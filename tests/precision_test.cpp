// The covariance against what noise does: 100 pairs that differ in nothing but their noise.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "scenes.hpp"
#include "simulation/random.hpp"

namespace igsp {
namespace {

using simulation::Random;
using testing::Pair;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Pair without_noise(std::string_view scene, int points) {
  SimulationOptions options;
  options.points = points;
  options.noise = 0.0;
  std::vector<SimulatedScan> scans = simulate(scene, options);
  const Transformation truth = scans[1].world_from_scanner.inverse() * scans[0].world_from_scanner;
  return {std::move(scans[0].points), std::move(scans[1].points), truth};
}

/// Along the ray, whose origin is the sensor's.
Points with_noise(Points points, double deviation, Random& random) {
  for (Eigen::Vector3d& point : points) point += deviation * random.normal() * point.normalized();
  return points;
}

/// The small motion about `centre` that takes `b` to `a`, applied on the left.
Vector6 motion_between(const Transformation& a, const Transformation& b, const Eigen::Vector3d& centre) {
  const Transformation motion = a * b.inverse();
  const Eigen::AngleAxisd rotation(motion.linear());
  Vector6 result;
  result << rotation.angle() * rotation.axis(), motion * centre - centre;
  return result;
}

struct Draws {
  std::vector<Vector6> errors;  // about each result's own centre
  std::vector<Matrix6> information;
  double voxel_size = 0.0;

  Vector6 mean() const {
    Vector6 sum = Vector6::Zero();
    for (const Vector6& error : errors) sum += error;
    return sum / static_cast<double>(errors.size());
  }
  /// Mean squared Mahalanobis distance from `from`, per degree of freedom: 1 where the covariance is the truth.
  double mahalanobis(const Vector6& from) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < errors.size(); ++i) sum += (errors[i] - from).dot(information[i] * (errors[i] - from));
    return sum / (6.0 * static_cast<double>(errors.size()));
  }
};

/// Estimates from starts 0.5 degrees off, so that no draw begins at the answer.
Draws draw(std::string_view scene, int points, double noise) {
  const Pair ideal = without_noise(scene, points);
  Draws draws;
  for (std::uint64_t i = 0; i < 100; ++i) {
    Random random(1, i);
    const Points source = with_noise(ideal.source, noise, random), target = with_noise(ideal.target, noise, random);
    const Transformation off(Eigen::AngleAxisd(0.5 * EIGEN_PI / 180.0, random.direction()));
    const Result result = align(source, target, off * ideal.truth);
    EXPECT_TRUE(result.registered) << result.reason;
    draws.errors.push_back(motion_between(result.target_from_source, ideal.truth, result.precision.centre));
    draws.information.push_back(result.precision.information);
    draws.voxel_size = result.voxel_size;
  }
  return draws;
}

// Noise is a part of what a pose errs by: the covariance counts what whole patches share as well, so that it says more
// than noise alone does.
TEST(Covariance, HoldsTheSpreadOverHundredNoiseDrawsOfAnObject) {
  const Draws draws = draw("object", 20000, 1e-4);
  EXPECT_GT(draws.mahalanobis(draws.mean()), 0.1);
  EXPECT_LT(draws.mahalanobis(draws.mean()), 1.1);
  EXPECT_LT(draws.mahalanobis(Vector6::Zero()), 1.5);
}

TEST(Covariance, HoldsTheSpreadOverHundredNoiseDrawsOfARoom) {
  const Draws draws = draw("indoor", 40000, 0.005);
  EXPECT_GT(draws.mahalanobis(draws.mean()), 0.05);
  EXPECT_LT(draws.mahalanobis(draws.mean()), 1.1);
  EXPECT_LT(draws.mean().tail<3>().norm(), 0.05 * draws.voxel_size);
}

// Scenes of every kind, each sampled in its own way: the ellipsoids of 95 % hold the truth of nine in ten.
TEST(Covariance, HoldsTheTruthOfAsManyScenesAsItSays) {
  constexpr double chi_square_95 = 12.592;  // 6 degrees of freedom
  int pairs = 0, inside = 0;
  for (const char* scene : {"park", "indoor", "object"}) {
    for (std::uint64_t seed = 101; seed <= 112; ++seed) {
      const Pair clouds = testing::simulated_pair(scene, 20000, 0.0, seed);
      const Result result = align(clouds.source, clouds.target, clouds.truth);
      if (!result.registered) continue;
      const Vector6 error = motion_between(result.target_from_source, clouds.truth, result.precision.centre);
      ++pairs;
      inside += error.dot(result.precision.information * error) < chi_square_95;
    }
  }
  EXPECT_GT(pairs, 27);
  EXPECT_GE(inside, 0.87 * pairs) << inside << " of " << pairs;
}

class PrecisionOf : public ::testing::TestWithParam<const char*> {
 protected:
  Pair pair() const { return testing::simulated_pair(GetParam(), 40000); }
};
INSTANTIATE_TEST_SUITE_P(Scenes, PrecisionOf, ::testing::Values("park", "indoor", "object"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(PrecisionOf, CovarianceIsTheInverseOfTheInformation) {
  const Pair clouds = pair();
  const Precision precision = align(clouds.source, clouds.target).precision;
  // In units in which both blocks are near 1; otherwise the tolerances would mean nothing.
  const Vector6 deviation = precision.covariance.diagonal().cwiseSqrt();
  ASSERT_GT(deviation.minCoeff(), 0.0);
  const Matrix6 correlation =
      deviation.asDiagonal().inverse() * precision.covariance * deviation.asDiagonal().inverse();
  EXPECT_LT((correlation - correlation.transpose()).norm(), 1e-9);
  EXPECT_EQ(Eigen::LLT<Matrix6>(correlation).info(), Eigen::Success) << "not positive definite";
  const Matrix6 information = deviation.asDiagonal() * precision.information * deviation.asDiagonal();
  EXPECT_LT((information - information.transpose()).norm(), 1e-9 * information.norm());
  EXPECT_LT((information * correlation - Matrix6::Identity()).norm(), 1e-9);
}

TEST_P(PrecisionOf, ScalesWithTheUnitOfLength) {
  const Pair clouds = pair();
  const double unit = 1024.0;  // a power of two rounds nothing
  const auto scaled = [unit](Points points) {
    for (Eigen::Vector3d& point : points) point *= unit;
    return points;
  };
  const Precision metres = align(clouds.source, clouds.target).precision;
  const Precision other = align(scaled(clouds.source), scaled(clouds.target)).precision;
  const Vector6 factor = (Vector6() << 1, 1, 1, unit, unit, unit).finished();
  const Matrix6 expected = factor.asDiagonal() * metres.covariance * factor.asDiagonal();
  EXPECT_LT((other.centre - unit * metres.centre).norm(), 1e-9 * unit);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(other.covariance(i, j), expected(i, j), 1e-6 * std::sqrt(expected(i, i) * expected(j, j)));
}

}  // namespace
}  // namespace igsp
