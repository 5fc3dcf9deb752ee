#include "igsp/diagnosis.hpp"

#include <gtest/gtest.h>

#include "scenes.hpp"

namespace igsp {
namespace {

using testing::Pair;
using testing::simulated_pair;

constexpr double pi = 3.14159265358979;

template <typename Function>
Points each(Points points, const Function& function) {
  for (Eigen::Vector3d& point : points) point = function(point);
  return points;
}

std::vector<Diagnosis> causes_of_refusal(PointView source, PointView target, const DiagnosisOptions& options = {}) {
  const Result result = align(source, target);
  EXPECT_FALSE(result.registered);
  return diagnose(source, target, result, options);
}

const Pair& room() {
  static const Pair pair = simulated_pair("indoor", 40000);
  return pair;
}

Eigen::Vector3d rounded(const Eigen::Vector3d& point, double step) {
  return (point / step).array().round() * step;
}

// Small angles in degrees, around Munich.
Eigen::Vector3d geographic(const Eigen::Vector3d& point) {
  constexpr double metres_per_degree = 111320;
  const double shrunk = std::cos(48.1 * pi / 180);
  return {11.5 + point.x() / (metres_per_degree * shrunk), 48.1 + point.y() / metres_per_degree, 500 + point.z()};
}

#define ASSERT_ONLY_CAUSE(causes, expected) \
  ASSERT_EQ((causes).size(), 1u);           \
  EXPECT_EQ((causes)[0].cause, expected)

#define EXPECT_SAYS(causes, words) \
  EXPECT_NE((causes)[0].description.find(words), std::string::npos) << (causes)[0].description

TEST(Diagnosis, LeftHandedSourceIsNamedAndItsReflectionGiven) {
  const Pair& pair = room();
  const Eigen::Vector3d left_handed(1, 1, -1);  // another axis than is tried
  const Points source = each(pair.source, [&](const auto& point) { return point.cwiseProduct(left_handed).eval(); });
  const auto causes = causes_of_refusal(source, pair.target);
  ASSERT_ONLY_CAUSE(causes, Cause::mirrored);
  EXPECT_SAYS(causes, "left-handed");
  ASSERT_TRUE(causes[0].target_from_source);
  Eigen::Matrix4d truth = pair.truth.matrix();
  truth.leftCols<3>() *= left_handed.asDiagonal();
  EXPECT_LT((*causes[0].target_from_source - truth).cwiseAbs().maxCoeff(), 0.05);
}

TEST(Diagnosis, AnotherUnitOfLengthIsNamed) {
  static constexpr double feet_per_metre = 3.28084;
  const Pair& pair = room();
  const Points source = each(pair.source, [](const auto& point) { return (feet_per_metre * point).eval(); });
  const auto causes = causes_of_refusal(source, pair.target);
  ASSERT_ONLY_CAUSE(causes, Cause::scale);
  EXPECT_SAYS(causes, "0.3048 turns feet into metres");
  ASSERT_TRUE(causes[0].target_from_source);
  const double cubed = causes[0].target_from_source->determinant();
  EXPECT_NEAR(cubed, std::pow(1 / feet_per_metre, 3), 1e-4);
}

TEST(Diagnosis, FivePercentTooLongIsNamed) {
  const Pair& pair = room();
  const Points source = each(pair.source, [](const auto& point) { return (1.05 * point).eval(); });
  const auto causes = causes_of_refusal(source, pair.target);
  ASSERT_ONLY_CAUSE(causes, Cause::scale);
  EXPECT_SAYS(causes, "multiplied by 0.95");
  Eigen::Matrix4d truth = pair.truth.matrix();
  truth.leftCols<3>() /= 1.05;
  ASSERT_TRUE(causes[0].target_from_source);
  EXPECT_LT((*causes[0].target_from_source - truth).cwiseAbs().maxCoeff(), 0.05);
}

TEST(Diagnosis, WithoutSearchOnlyTheCoordinatesAreLookedAt) {
  const Points source =
      each(room().source, [](const auto& point) { return Eigen::Vector3d(-point.x(), point.y(), point.z()); });
  EXPECT_TRUE(causes_of_refusal(source, room().target, {.search = false}).empty());
}

TEST(Diagnosis, FlatCloudsAreNamed) {
  const auto flat = [](const Eigen::Vector3d& point) { return Eigen::Vector3d(point.x(), point.y(), 0); };
  const Points source = each(room().source, flat), target = each(room().target, flat);
  const auto both = causes_of_refusal(source, target);
  ASSERT_ONLY_CAUSE(both, Cause::flat);
  EXPECT_SAYS(both, "z is 0 everywhere in both clouds");
  const auto one = causes_of_refusal(source, room().target);
  ASSERT_ONLY_CAUSE(one, Cause::flat);
  EXPECT_SAYS(one, "z is 0 everywhere in the source");
  const Transformation tilt = testing::random_motion(3, 40.0);
  const auto tilted = causes_of_refusal(room().source, testing::moved(tilt, target));
  ASSERT_ONLY_CAUSE(tilted, Cause::flat);
  EXPECT_SAYS(tilted, "all points of the target lie on one plane");
}

TEST(Diagnosis, PlaneWithNoiseIsNotCalledFlat) {
  const Pair plane = simulated_pair("plane", 20000);
  EXPECT_TRUE(causes_of_refusal(plane.source, plane.target, {.search = false}).empty());
}

TEST(Diagnosis, DegreesInPlaceOfMetresAreNamed) {
  const auto causes = causes_of_refusal(each(room().source, geographic), each(room().target, geographic));
  ASSERT_ONLY_CAUSE(causes, Cause::degrees);
  EXPECT_SAYS(causes, "both clouds look like longitude and latitude");
  const auto one = causes_of_refusal(room().source, each(room().target, geographic));
  ASSERT_ONLY_CAUSE(one, Cause::degrees);
  EXPECT_SAYS(one, "the target");
}

TEST(Diagnosis, SurveyCoordinatesInFloatsAreNamed) {
  const auto stored = [](const Eigen::Vector3d& point) {
    Eigen::Vector3d kept = point + Eigen::Vector3d(450000, 5400000, 300);
    for (double& coordinate : kept) {
      volatile float as_float = static_cast<float>(coordinate);  // GCC 12 leaves the rounding out otherwise
      coordinate = as_float;
    }
    return kept;
  };
  const auto causes = causes_of_refusal(each(room().source, stored), each(room().target, stored));
  ASSERT_ONLY_CAUSE(causes, Cause::coarse_coordinates);
  EXPECT_SAYS(causes, "y of both clouds comes in steps of 0.5");
  EXPECT_SAYS(causes, "as floats");
}

TEST(Diagnosis, DecimalStepsAreNamed) {
  const auto coarse = [](const Eigen::Vector3d& point) { return rounded(point, 0.1); };
  const auto causes = causes_of_refusal(each(room().source, coarse), each(room().target, coarse));
  ASSERT_ONLY_CAUSE(causes, Cause::coarse_coordinates);
  EXPECT_SAYS(causes, "steps of 0.1 ");
  EXPECT_SAYS(causes, "more digits");
}

TEST(Diagnosis, FewPointsAreNamed) {
  Points few;
  for (std::size_t i = 0; i < room().source.size(); i += 1000) few.push_back(room().source[i]);
  const auto causes = causes_of_refusal(few, room().target);
  ASSERT_ONLY_CAUSE(causes, Cause::too_few_points);
  EXPECT_SAYS(causes, "few points in the source: 4");
}

TEST(Diagnosis, CloudsOfDifferentPlacesHaveNoCause) {
  EXPECT_TRUE(causes_of_refusal(room().source, simulated_pair("park", 40000).target).empty());
}

TEST(Diagnosis, RegisteredPairIsNotAskedFor) {
  const Result result = align(room().source, room().target);
  ASSERT_TRUE(result.registered);
  EXPECT_TRUE(diagnose(room().source, room().target, result).empty());
}

TEST(Diagnosis, NothingToRegisterHasItsReason) {
  const Points one(100, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(causes_of_refusal(one, one).empty());
}

}  // namespace
}  // namespace igsp
