// What must hold of `align` whatever the scene: symmetry, equivariance, independence of order, unit, origin and threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <tuple>

#include "scenes.hpp"

namespace igsp {
namespace {

using testing::disagreement;
using testing::moved;
using testing::Pair;
using testing::random_motion;

// Where the voxel grid lies is an accident of the frame: a moved cloud, or the inverse question, is answered from other
// centroids. The answers may differ by what that resampling does to a surface fit, a fraction of the voxel size.
constexpr double resampling_tolerance = 0.2;  // [voxels]

// Only rounding may differ: sums in another order, coordinates scaled or shifted.
constexpr double rounding_tolerance = 1e-6;  // [metres]

class Laws : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  const char* scene() const { return std::get<0>(GetParam()); }
  Options options() const { return preset(std::get<1>(GetParam())); }
  Pair pair() const { return testing::simulated_pair(scene(), 40000); }
};

void expect_rigid(const Transformation& transformation) {
  const Eigen::Matrix3d rotation = transformation.linear();
  EXPECT_LT((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(rotation.determinant(), 1.0, 1e-12);
  EXPECT_EQ(transformation.matrix().row(3), Eigen::RowVector4d(0, 0, 0, 1));
}

TEST_P(Laws, FindsTheTruth) {
  const Pair clouds = pair();
  const Result result = align(clouds.source, clouds.target, options());
  ASSERT_TRUE(result.registered) << result.reason;
  expect_rigid(result.target_from_source);
  EXPECT_LT(disagreement(result.target_from_source, clouds.truth, clouds.source), result.voxel_size);
}

TEST_P(Laws, InverseOfTheInverseQuestion) {
  const Pair clouds = pair();
  const Result forward = align(clouds.source, clouds.target, options());
  const Result backward = align(clouds.target, clouds.source, options());
  ASSERT_TRUE(forward.registered && backward.registered) << forward.reason << "\n" << backward.reason;
  EXPECT_LT(disagreement(forward.target_from_source, backward.target_from_source.inverse(), clouds.source),
            resampling_tolerance * forward.voxel_size);
}

TEST_P(Laws, MovesWithItsClouds) {
  const Pair clouds = pair();
  const Result still = align(clouds.source, clouds.target, options());
  const double length = 3.0 * testing::radius_of_gyration(clouds.source);
  const Transformation g = random_motion(1, length);
  const Transformation h = random_motion(2, length);
  const Result result = align(moved(g, clouds.source), moved(h, clouds.target), options());
  ASSERT_TRUE(still.registered && result.registered) << still.reason << "\n" << result.reason;
  expect_rigid(result.target_from_source);
  EXPECT_LT(disagreement(h.inverse() * result.target_from_source * g, still.target_from_source, clouds.source),
            resampling_tolerance * still.voxel_size);
}

TEST_P(Laws, SurveyCoordinatesLoseNothing) {
  const Pair clouds = pair();
  const Transformation shift(Eigen::Translation3d(500000.0, 5000000.0, 100.0));
  const Result near = align(clouds.source, clouds.target, options());
  const Result far = align(moved(shift, clouds.source), moved(shift, clouds.target), options());
  ASSERT_TRUE(near.has_estimate && far.has_estimate);
  EXPECT_LT(disagreement(shift.inverse() * far.target_from_source * shift, near.target_from_source, clouds.source),
            rounding_tolerance);
  EXPECT_EQ(near.registered, far.registered);
}

TEST_P(Laws, UnitOfLengthDoesNotMatter) {
  const Pair clouds = pair();
  const double unit = 1000.0;
  const auto scaled = [&](const Points& points) {
    Points result = points;
    for (Eigen::Vector3d& point : result) point *= unit;
    return result;
  };
  const Result metres = align(clouds.source, clouds.target, options());
  const Result millimetres = align(scaled(clouds.source), scaled(clouds.target), options());
  ASSERT_TRUE(metres.has_estimate && millimetres.has_estimate);
  Transformation back = millimetres.target_from_source;
  back.translation() /= unit;
  EXPECT_LT(disagreement(back, metres.target_from_source, clouds.source), rounding_tolerance);
  EXPECT_NEAR(millimetres.voxel_size, unit * metres.voxel_size, 1e-9 * unit);
  EXPECT_EQ(millimetres.registered, metres.registered);
}

TEST_P(Laws, OrderOfPointsDoesNotMatter) {
  const Pair clouds = pair();
  Points source = clouds.source;
  Points target = clouds.target;
  std::mt19937_64 random(3);
  std::shuffle(source.begin(), source.end(), random);
  std::shuffle(target.begin(), target.end(), random);
  const Result ordered = align(clouds.source, clouds.target, options());
  const Result shuffled = align(source, target, options());
  ASSERT_TRUE(ordered.has_estimate && shuffled.has_estimate);
  EXPECT_LT(disagreement(ordered.target_from_source, shuffled.target_from_source, clouds.source), rounding_tolerance);
  EXPECT_EQ(ordered.registered, shuffled.registered);
}

bool same_bits(const Transformation& a, const Transformation& b) {
  return std::memcmp(a.data(), b.data(), 16 * sizeof(double)) == 0;
}

TEST_P(Laws, BitIdenticalForEveryThreadCount) {
  const Pair clouds = pair();
  Options chosen = options();
  chosen.threads = 1;
  const Result one = align(clouds.source, clouds.target, chosen);
  for (const int threads : {2, 4}) {
    chosen.threads = threads;
    const Result many = align(clouds.source, clouds.target, chosen);
    EXPECT_TRUE(same_bits(one.target_from_source, many.target_from_source)) << threads << " threads";
    EXPECT_EQ(one.rmse, many.rmse);
    EXPECT_EQ(one.overlap_source, many.overlap_source);
    ASSERT_EQ(one.iterations.size(), many.iterations.size());
    for (std::size_t k = 0; k < one.iterations.size(); ++k) {
      EXPECT_EQ(one.iterations[k].energy, many.iterations[k].energy) << "iteration " << k;
      EXPECT_TRUE(same_bits(one.iterations[k].target_from_source, many.iterations[k].target_from_source)) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Laws,
                         ::testing::Combine(::testing::Values("park", "indoor", "object"),
                                            ::testing::Values("paper", "default")),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param)) + "_" + std::get<1>(info.param);
                         });

class AnyPreset : public ::testing::TestWithParam<const char*> {
 protected:
  Options options() const { return preset(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Presets, AnyPreset, ::testing::Values("paper", "default"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(AnyPreset, RefusesWhatIsNoCloud) {
  const Points good = testing::simulated_pair("object", 5000).source;
  EXPECT_THROW(align(Points{}, good, options()), InvalidArgument);
  EXPECT_THROW(align(good, Points{}, options()), InvalidArgument);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Points broken = good;
    broken[broken.size() / 2].y() = bad;
    EXPECT_THROW(align(broken, good, options()), InvalidArgument);
    EXPECT_THROW(align(good, broken, options()), InvalidArgument);
  }
}

Points line(int count) {
  Points points;
  for (int i = 0; i < count; ++i) points.emplace_back(0.01 * i, 0.02 * i, -0.03 * i);
  return points;
}

Points plane(int side) {
  Points points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) points.emplace_back(0.1 * i, 0.1 * j, 0.05 * i - 0.02 * j);
  return points;
}

/// Clouds that no method can register: nothing in them says how to turn or where to stop sliding.
std::vector<std::pair<std::string, Points>> degenerate_clouds() {
  return {{"one point", {Eigen::Vector3d(1, 2, 3)}},
          {"two points", {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(2, 2, 3)}},
          {"all equal", Points(1000, Eigen::Vector3d(1, 2, 3))},
          {"a million duplicates", Points(1000000, Eigen::Vector3d(-4, 5, 0.1))},
          {"collinear", line(2000)},
          {"coplanar", plane(60)}};
}

void expect_honest_refusal(const Result& result) {
  EXPECT_FALSE(result.registered);
  EXPECT_FALSE(result.reason.empty());
  EXPECT_TRUE(result.target_from_source.matrix().allFinite());
}

TEST_P(AnyPreset, RefusesDegenerateClouds) {
  const Points good = testing::simulated_pair("object", 5000).source;
  for (const auto& [name, cloud] : degenerate_clouds()) {
    SCOPED_TRACE(name);
    expect_honest_refusal(align(cloud, cloud, options()));
    expect_honest_refusal(align(cloud, good, options()));
    expect_honest_refusal(align(good, cloud, options()));
  }
}

TEST_P(AnyPreset, DuplicatedPointsChangeNothing) {
  const Pair clouds = testing::simulated_pair("park", 40000);
  Points doubled = clouds.source;
  doubled.insert(doubled.end(), clouds.source.begin(), clouds.source.end());
  Options chosen = options();
  chosen.scale.voxel_size = align(clouds.source, clouds.target, options()).voxel_size;
  const Result once = align(clouds.source, clouds.target, chosen);
  const Result twice = align(doubled, clouds.target, chosen);
  EXPECT_LT(disagreement(once.target_from_source, twice.target_from_source, clouds.source), rounding_tolerance);
}

TEST_P(AnyPreset, ProgressIsReportedInOrder) {
  const Pair clouds = testing::simulated_pair("park", 40000);
  std::vector<std::pair<std::string, double>> reports;
  align(clouds.source, clouds.target, options(), [&](const Progress& progress) {
    reports.emplace_back(progress.stage, progress.fraction);
    return true;
  });
  ASSERT_GE(reports.size(), 10u) << "too few reports to stop promptly between them";
  for (const auto& [stage, fraction] : reports) {
    EXPECT_FALSE(stage.empty());
    EXPECT_GE(fraction, 0.0) << stage;
    EXPECT_LE(fraction, 1.0) << stage;
  }
}

TEST_P(AnyPreset, StopsAtTheFirstRefusal) {
  const Pair clouds = testing::simulated_pair("object", 10000);
  int total = 0;
  align(clouds.source, clouds.target, options(), [&](const Progress&) { return ++total > 0; });
  for (const int last : {1, 2, total / 2, total}) {
    int calls = 0;
    EXPECT_THROW(align(clouds.source, clouds.target, options(), [&](const Progress&) { return ++calls < last; }),
                 Cancelled);
    EXPECT_EQ(calls, last) << "work went on after the callback said stop";
  }
}

}  // namespace
}  // namespace igsp
