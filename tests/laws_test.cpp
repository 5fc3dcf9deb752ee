// What must hold of `align` whatever the scene: symmetry, equivariance, independence of order, unit, origin and
// threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "scenes.hpp"

namespace igsp {
namespace {

using testing::disagreement;
using testing::moved;
using testing::Pair;
using testing::random_motion;

// What may differ between two answers to the same question, as a displacement of the source [voxels].
struct Tolerance {
  double truth;       // against the simulated poses
  double resampling;  // both clouds moved: the voxel grid lies elsewhere, so keypoints and surfaces are sampled anew
  double rounding;    // every coordinate rounded anew: rarely, one bit of one descriptor flips
};

// The paper's loop ends with a fit to the matched keypoints, each good to about a voxel, so one match more or less
// moves the answer by a good part of a voxel; seen up to 0.8.
constexpr Tolerance of_paper = {1.5, 1.5, 1.5};

// The default preset ends with a refinement on the surfaces, which averages over thousands of points; seen up to 0.1.
constexpr Tolerance of_default = {0.3, 0.2, 0.05};

// Only the order of sums, or the origin that coordinates are relative to, changed: no match may change.
constexpr double exact_tolerance = 1e-6;  // [metres]

struct LawCase {
  const char* preset;
  const char* scene;
  double station_distance;  // 0: the scene's own. The paper's loop needs more overlap than the default preset does.
  Tolerance tolerance;
};

void PrintTo(const LawCase& law, std::ostream* out) {
  *out << law.preset << " " << law.scene;
}

std::string name_of(const ::testing::TestParamInfo<LawCase>& info) {
  return std::string(info.param.preset) + "_" + info.param.scene;
}

class Laws : public ::testing::TestWithParam<LawCase> {
 protected:
  Options options() const { return preset(GetParam().preset); }
  Pair pair() const { return testing::simulated_pair(GetParam().scene, 40000, GetParam().station_distance); }
  Tolerance tolerance() const { return GetParam().tolerance; }
};

INSTANTIATE_TEST_SUITE_P(
    Scenes, Laws,
    ::testing::Values(LawCase{"paper", "park", 1.0, of_paper}, LawCase{"paper", "indoor", 0.1, of_paper},
                      LawCase{"paper", "object", 0.02, of_paper}, LawCase{"default", "park", 0.0, of_default},
                      LawCase{"default", "indoor", 0.0, of_default}, LawCase{"default", "object", 0.0, of_default}),
    name_of);

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
  EXPECT_LT(disagreement(result.target_from_source, clouds.truth, clouds.source),
            tolerance().truth * result.voxel_size);
}

// One and the same cloud moves inside, so nothing may differ but the side from which the answer is told.
void expect_exchanged(const Result& forward, const Result& backward, PointView source) {
  EXPECT_EQ(forward.registered, backward.registered);
  EXPECT_EQ(forward.confidence, backward.confidence);
  EXPECT_EQ(forward.evidence.quality, backward.evidence.quality);
  EXPECT_EQ(forward.overlap_source, backward.overlap_target);
  EXPECT_EQ(forward.overlap_target, backward.overlap_source);
  EXPECT_EQ(forward.source.voxels, backward.target.voxels);
  EXPECT_EQ(forward.source_keypoints, backward.target_keypoints);
  EXPECT_EQ(forward.precision.inlier_rmse, backward.precision.inlier_rmse);
  EXPECT_LT(disagreement(forward.target_from_source, backward.target_from_source.inverse(), source), exact_tolerance);
}

TEST_P(Laws, InverseOfTheInverseQuestion) {
  const Pair clouds = pair();
  const Result forward = align(clouds.source, clouds.target, options());
  const Result backward = align(clouds.target, clouds.source, options());
  ASSERT_TRUE(forward.registered && backward.registered) << forward.reason << "\n" << backward.reason;
  expect_exchanged(forward, backward, clouds.source);
  ASSERT_EQ(forward.iterations.size(), backward.iterations.size());
  const IterationRecord &last = forward.iterations.back(), &turned = backward.iterations.back();
  ASSERT_EQ(last.correspondences.size(), turned.correspondences.size());
  for (std::size_t i = 0; i < last.correspondences.size(); ++i) {
    EXPECT_EQ(last.correspondences[i].source, turned.correspondences[i].target);
    EXPECT_EQ(last.correspondences[i].target, turned.correspondences[i].source);
  }
  EXPECT_LT(disagreement(last.target_from_source, turned.target_from_source.inverse(), clouds.source), exact_tolerance);
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
            tolerance().resampling * still.voxel_size);
}

/// The answer for both clouds shifted to survey coordinates, shifted back.
Transformation align_far_away(const Pair& clouds, const Options& options) {
  const Transformation shift(Eigen::Translation3d(500000.0, 5000000.0, 100.0));
  const Result far = align(moved(shift, clouds.source), moved(shift, clouds.target), options);
  EXPECT_TRUE(far.registered) << far.reason;
  return shift.inverse() * far.target_from_source * shift;
}

TEST_P(Laws, SurveyCoordinatesLoseNothing) {
  Pair clouds = pair();
  const Result raw = align(clouds.source, clouds.target, options());
  EXPECT_LT(disagreement(align_far_away(clouds, options()), raw.target_from_source, clouds.source),
            tolerance().rounding * raw.voxel_size);

  // A double at 5,000,000 m holds multiples of 2^-30 m. Coordinates that are such multiples lose nothing in the shift
  // itself, so that whatever differs, the library lost.
  for (Points* points : {&clouds.source, &clouds.target})
    for (Eigen::Vector3d& point : *points) point = (point * 0x1p30).array().round() * 0x1p-30;
  const Result exact = align(clouds.source, clouds.target, options());
  EXPECT_LT(disagreement(align_far_away(clouds, options()), exact.target_from_source, clouds.source), exact_tolerance);
}

/// align in another unit of length, with the answer converted back.
Result align_in_unit(double unit, const Pair& clouds, const Options& options) {
  const auto scaled = [unit](Points points) {
    for (Eigen::Vector3d& point : points) point *= unit;
    return points;
  };
  Result result = align(scaled(clouds.source), scaled(clouds.target), options);
  result.target_from_source.translation() /= unit;
  result.voxel_size /= unit;
  return result;
}

TEST_P(Laws, UnitOfLengthDoesNotMatter) {
  const Pair clouds = pair();
  const Result metres = align(clouds.source, clouds.target, options());
  // A power of two rounds nothing: any difference would be a length hidden in the code.
  const Result binary = align_in_unit(1024.0, clouds, options());
  EXPECT_EQ(binary.voxel_size, metres.voxel_size);
  EXPECT_LT(disagreement(binary.target_from_source, metres.target_from_source, clouds.source),
            1e-12 * metres.voxel_size);

  const Result millimetres = align_in_unit(1000.0, clouds, options());
  EXPECT_NEAR(millimetres.voxel_size, metres.voxel_size, 1e-9 * metres.voxel_size);
  EXPECT_LT(disagreement(millimetres.target_from_source, metres.target_from_source, clouds.source),
            tolerance().rounding * metres.voxel_size);
  for (const Result& result : {metres, binary, millimetres}) EXPECT_TRUE(result.registered) << result.reason;
}

bool same_bits(const Transformation& a, const Transformation& b) {
  return std::memcmp(a.data(), b.data(), 16 * sizeof(double)) == 0;
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
  ASSERT_TRUE(ordered.registered && shuffled.registered) << ordered.reason << "\n" << shuffled.reason;
  EXPECT_TRUE(same_bits(ordered.target_from_source, shuffled.target_from_source));
  EXPECT_EQ(ordered.reason, shuffled.reason);
  EXPECT_EQ(ordered.confidence, shuffled.confidence);
  EXPECT_EQ(ordered.precision.covariance, shuffled.precision.covariance);
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

// In sparse rooms the verdict is close, and what is close must not hang on which scan is called the source.
TEST(LawsOfTheVerdict, SparseRoomsExchangedAreJudgedAlike) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const Pair clouds = testing::simulated_pair("indoor", 3000, 0.0, seed);
    expect_exchanged(align(clouds.source, clouds.target), align(clouds.target, clouds.source), clouds.source);
  }
}

// Of equal counts, where only the coordinates can say which one moves.
TEST(LawsOfTheVerdict, CloudsOfEqualCountsExchangedAreJudgedAlike) {
  const Points points = testing::simulated_pair("object", 5000).source;
  const Points copy = moved(Transformation(Eigen::Translation3d(0.25, 0, 0)), points);
  const Result forward = align(points, copy), backward = align(copy, points);
  EXPECT_EQ(forward.source.voxels, forward.target.voxels);
  expect_exchanged(forward, backward, points);
}

TEST(LawsOfTheVerdict, CovarianceOfTheExchangedPairIsTheSameInTheOtherFrame) {
  const Pair clouds = testing::scrambled(testing::simulated_pair("park", 40000), 3);
  const Result forward = align(clouds.source, clouds.target), backward = align(clouds.target, clouds.source);
  ASSERT_TRUE(forward.registered) << forward.reason;
  const Eigen::Matrix3d turn = backward.target_from_source.linear();
  const double size = testing::radius_of_gyration(clouds.source);
  EXPECT_LT((backward.precision.centre - backward.target_from_source * forward.precision.centre).norm(), 1e-9 * size);
  for (const int block : {0, 3}) {
    const Eigen::Matrix3d given = forward.precision.covariance.block<3, 3>(block, block);
    const Eigen::Matrix3d turned = backward.precision.covariance.block<3, 3>(block, block);
    EXPECT_GT(given.trace(), 0);
    EXPECT_LT((turned - turn * given * turn.transpose()).norm(), 1e-9 * given.norm());
  }
  EXPECT_NEAR(forward.precision.scale * backward.precision.scale, 1, 1e-12);
}

TEST(LawsOfTheVerdict, TheLevelDecidesAndChangesNothingElse) {
  const Pair clouds = testing::simulated_pair("park", 20000);
  const Result usual = align(clouds.source, clouds.target);
  ASSERT_TRUE(usual.registered) << usual.reason;
  ASSERT_LT(usual.confidence, 1);
  Options options;
  options.level = usual.confidence;
  EXPECT_TRUE(align(clouds.source, clouds.target, options).registered);
  options.level = std::nextafter(usual.confidence, 1);
  const Result refused = align(clouds.source, clouds.target, options);
  EXPECT_FALSE(refused.registered);
  EXPECT_NE(refused.reason.find("below the level"), std::string::npos) << refused.reason;
  EXPECT_EQ(refused.confidence, usual.confidence);
  EXPECT_EQ(refused.target_from_source.matrix(), usual.target_from_source.matrix());
}

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

void expect_honest_refusal(PointView source, PointView target, const Options& options) {
  const Result result = align(source, target, options);
  EXPECT_FALSE(result.registered);
  EXPECT_FALSE(result.reason.empty());
  EXPECT_TRUE(result.target_from_source.matrix().allFinite());
}

/// Clouds that no method can register: nothing in them says how to turn or where to stop sliding.
TEST_P(AnyPreset, RefusesDegenerateClouds) {
  const std::pair<const char*, Points> degenerate[] = {
      {"one point", {Eigen::Vector3d(1, 2, 3)}},
      {"two points", {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(2, 2, 3)}},
      {"all equal", Points(1000, Eigen::Vector3d(1, 2, 3))},
      {"a million duplicates", Points(1000000, Eigen::Vector3d(-4, 5, 0.1))},
      {"collinear", line(2000)},
      {"coplanar", plane(60)}};
  const Points good = testing::simulated_pair("object", 5000).source;
  for (const auto& [name, cloud] : degenerate) {
    SCOPED_TRACE(name);
    EXPECT_NO_THROW(expect_honest_refusal(cloud, cloud, options()));
    EXPECT_NO_THROW(expect_honest_refusal(cloud, good, options()));
    EXPECT_NO_THROW(expect_honest_refusal(good, cloud, options()));
  }
}

TEST_P(AnyPreset, DuplicatedPointsChangeNothing) {
  const Pair clouds = testing::simulated_pair("park", 40000, 1.0);
  Points doubled = clouds.source;
  doubled.insert(doubled.end(), clouds.source.begin(), clouds.source.end());
  Options chosen = options();
  chosen.scale.voxel_size = align(clouds.source, clouds.target, options()).voxel_size;
  const Result once = align(clouds.source, clouds.target, chosen);
  const Result twice = align(doubled, clouds.target, chosen);
  EXPECT_LT(disagreement(once.target_from_source, twice.target_from_source, clouds.source), exact_tolerance);
}

TEST_P(AnyPreset, ProgressIsReportedInOrder) {
  const Pair clouds = testing::simulated_pair("park", 40000, 1.0);
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
  Options alone = options();
  alone.threads = 1;  // with more, how often they report depends on who is first
  int total = 0;
  align(clouds.source, clouds.target, alone, [&](const Progress&) { return ++total > 0; });
  for (const int last : {1, 2, total / 2, total}) {
    int calls = 0;
    EXPECT_THROW(align(clouds.source, clouds.target, alone, [&](const Progress&) { return ++calls < last; }),
                 Cancelled);
    EXPECT_EQ(calls, last) << "work went on after the callback said stop";
  }
}

}  // namespace
}  // namespace igsp
