#include "registration/igsp_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "features/bsc.hpp"
#include "features/features_testing.hpp"
#include "igsp/errors.hpp"
#include "igsp/evaluation.hpp"

namespace igsp {
namespace {

using testing::Random;

constexpr double voxel_size = 0.1;

Options loop_options() {
  Options options = preset("paper");
  options.threads = 1;
  return options;
}

/// Keypoints of both clouds with the storage that LoopInput refers to.
struct Pair {
  Points source, target;
  std::vector<Descriptor> source_variants, target_descriptors;
  Transformation truth = Transformation::Identity();
  int variants = 4;
  LoopInput input() const { return {source, target, source_variants, variants, target_descriptors, voxel_size}; }
};

Descriptor with_changed_bits(Random& random, Descriptor descriptor, int count) {
  for (; count > 0; --count) {
    const int bit = random.integer(0, bsc_bits - 1);
    descriptor[bit / 64] ^= std::uint64_t{1} << (bit % 64);
  }
  return descriptor;
}

/// `size` keypoints, all or half of which the target has as well: moved, with a few bits changed, under another sign
/// variant. The others of both are clutter.
Pair make_pair(std::uint64_t seed, std::size_t size, const Transformation& truth, int variants, bool clutter) {
  Random random(seed);
  Pair pair;
  pair.truth = truth;
  pair.variants = variants;
  pair.source = testing::random_points(random, size, 3);
  std::vector<Descriptor> own;
  for (std::size_t i = 0; i < size; ++i) {
    own.push_back(testing::random_descriptor(random));
    const bool shared = !clutter || i % 2 == 0;
    pair.target.push_back(shared ? truth * pair.source[i] : truth * random.in_cube(3));
    pair.target_descriptors.push_back(
        shared ? flipped(with_changed_bits(random, own[i], 15), random.integer(0, variants - 1))
               : testing::random_descriptor(random));
  }
  pair.source_variants = sign_variants(own, variants);
  return pair;
}

Pair half_clutter(std::uint64_t seed, std::size_t size, const Transformation& truth, int variants = 4) {
  return make_pair(seed, size, truth, variants, true);
}
Pair moved_copy(std::uint64_t seed, std::size_t size, const Transformation& truth) {
  return make_pair(seed, size, truth, 4, false);
}

Transformation any_motion(std::uint64_t seed) {
  Random random(seed);
  return random.motion(20);
}

LoopOutcome run(const Pair& pair, const Options& options = loop_options(), const LoopSchedule& schedule = {},
                const Transformation& initial = Transformation::Identity()) {
  return igsp_loop(pair.input(), initial, schedule, options);
}

double error(const Transformation& found, const Transformation& truth) {
  return (found.matrix() - truth.matrix()).norm();
}

TEST(IgspLoop, FindsTheMotionAmongHalfClutter) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Pair pair = half_clutter(seed, 200, any_motion(seed));
    const LoopOutcome outcome = run(pair);
    EXPECT_EQ(outcome.termination, Termination::converged);
    ASSERT_TRUE(outcome.has_estimate);
    EXPECT_LT(error(outcome.target_from_source, pair.truth), 1e-9);
    EXPECT_EQ(outcome.iterations.back().matches, 100u);
  }
}

TEST(IgspLoop, FindsTheMotionUnderTheReleasedRule) {
  const Pair pair = half_clutter(1, 200, any_motion(1));
  Options options = loop_options();
  options.energy.threshold_rule = ThresholdRule::released;
  EXPECT_LT(error(run(pair, options).target_from_source, pair.truth), 1e-9);
}

TEST(IgspLoop, FindsYawAndTranslationOfLevelledScans) {
  Transformation truth(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()));
  truth.translation() = Eigen::Vector3d(4, -7, 1);
  const Pair pair = half_clutter(2, 200, truth, 2);
  Options options = loop_options();
  options.degrees_of_freedom = 4;
  const LoopOutcome outcome = run(pair, options);
  EXPECT_EQ(outcome.termination, Termination::converged);
  EXPECT_LT(error(outcome.target_from_source, truth), 1e-9);
  EXPECT_EQ(outcome.target_from_source.linear().col(2), Eigen::Vector3d::UnitZ());
}

// What the hypotheses search asks for: a later start, given bounds, a robust fit, from a pose that is nearly right.
TEST(IgspLoop, EntersLateWithBoundsFromAHypothesis) {
  const Pair pair = half_clutter(3, 200, any_motion(3));
  Transformation off(Eigen::AngleAxisd(0.03, Eigen::Vector3d(1, 2, 3).normalized()));
  off.translation() = Eigen::Vector3d(0.02, -0.01, 0.03);
  LoopSchedule schedule;
  schedule.first_k = 6;
  schedule.max_iterations = 20;
  schedule.fit_scale = 2;
  schedule.bounds = LoopSchedule::Bounds{100, 60};
  const LoopOutcome outcome = run(pair, loop_options(), schedule, pair.truth * off);
  EXPECT_EQ(outcome.termination, Termination::converged);
  EXPECT_LT(error(outcome.target_from_source, pair.truth), 1e-3);
  EXPECT_EQ(outcome.iterations.front().k, 6);
  for (const IterationRecord& record : outcome.iterations) {
    EXPECT_DOUBLE_EQ(record.t_cd, record.w_fd * 100 + record.w_ed * 60);
  }
}

TEST(IgspLoop, RecordsWhatHappened) {
  const Pair pair = half_clutter(4, 200, any_motion(4));
  const Options options = loop_options();
  const LoopOutcome outcome = run(pair, options);
  ASSERT_GE(outcome.iterations.size(), 2u);
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : pair.source) centroid += point / static_cast<double>(pair.source.size());
  Transformation before = Transformation::Identity();
  for (std::size_t i = 0; i < outcome.iterations.size(); ++i) {
    const IterationRecord& record = outcome.iterations[i];
    EXPECT_EQ(record.k, static_cast<int>(i));
    EXPECT_DOUBLE_EQ(record.w_fd, std::exp(-record.k / options.energy.weight_changing_rate));
    EXPECT_DOUBLE_EQ(record.w_fd + record.w_ed, 1);
    EXPECT_GE(record.t_cd, options.energy.min_threshold);
    EXPECT_GE(record.candidate_edges, record.matches);
    EXPECT_LE(record.matches, pair.source.size());
    EXPECT_GE(record.energy, 0);
    EXPECT_LE(record.energy, record.t_cd * 200 * (1 + 1e-9));  // that of no match at all
    EXPECT_GE(record.seconds, 0);
    const Transformation& after = record.target_from_source;
    EXPECT_NEAR(record.rotation_step_rad, rotation_error_rad(after.linear(), before.linear()), 1e-9);
    EXPECT_NEAR(record.translation_step, (after * centroid - before * centroid).norm(), 1e-9);
    before = after;
  }
  EXPECT_EQ(before.matrix(), outcome.target_from_source.matrix());
  const auto small = [&](const IterationRecord& record) {
    return record.rotation_step_rad < options.convergence.rotation_tolerance_rad &&
           record.translation_step < options.convergence.translation_tolerance * voxel_size;
  };
  EXPECT_TRUE(small(outcome.iterations.back()));
  EXPECT_TRUE(std::none_of(outcome.iterations.begin(), outcome.iterations.end() - 1, small));
}

// The first step puts a copy into place: what is left of the distances is 0, and Eq. 11 sees the bits alone.
TEST(IgspLoop, TakesTheThresholdFromResidualsAfterTheStep) {
  const Pair pair = moved_copy(12, 200, any_motion(12));
  const Options options = loop_options();
  const LoopOutcome outcome = run(pair, options);
  ASSERT_GE(outcome.iterations.size(), 2u);
  const IterationRecord &first = outcome.iterations[0], &second = outcome.iterations[1];
  ASSERT_LT(error(first.target_from_source, pair.truth), 1e-9);
  const double matches = static_cast<double>(first.matches);
  const double mean_fd = (first.energy - first.t_cd / 2 * (400 - 2 * matches)) / matches;  // Eq. 1 at W_ed = 0
  EXPECT_NEAR(second.t_cd, options.energy.p3 * second.w_fd * mean_fd, 1e-6);
}

// Eq. 3: one suppression radius farther off, a match costs distance_scale more, by the weight of the distance.
TEST(IgspLoop, ASuppressionRadiusWeighsAsTheDistanceScaleSays) {
  const Pair pair = moved_copy(14, 200, Transformation::Identity());
  const Options options = loop_options();
  LoopSchedule schedule;
  schedule.first_k = 6;
  schedule.max_iterations = 1;
  schedule.bounds = LoopSchedule::Bounds{100, 60};
  const double radius = options.keypoints.suppression_radius * voxel_size;
  const auto energy_off_by = [&](double distance) {
    const Transformation initial(Eigen::Translation3d(distance, 0, 0));
    const IterationRecord record = run(pair, options, schedule, initial).iterations.at(0);
    EXPECT_EQ(record.matches, 200u);
    return record.energy / record.w_ed;
  };
  for (const double radii : {0.25, 0.5}) {
    EXPECT_NEAR(energy_off_by(radii * radius) - energy_off_by(0), 200 * radii * options.energy.distance_scale, 1e-3);
  }
}

// A pure translation turns nothing, a rotation about the centroid moves it nowhere: neither is convergence.
TEST(IgspLoop, ConvergesOnlyWhenBothStepsAreSmall) {
  const Pair still = moved_copy(13, 200, Transformation::Identity());
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : still.source) centroid += point / static_cast<double>(still.source.size());
  const Eigen::Translation3d there(centroid);
  const Eigen::AngleAxisd turn(1.0, Eigen::Vector3d(1, 2, 3).normalized());
  for (const Transformation& truth :
       {Transformation(Eigen::Translation3d(3, 4, 5)), Transformation(there * turn * there.inverse())}) {
    const LoopOutcome outcome = run(moved_copy(13, 200, truth));
    EXPECT_EQ(outcome.termination, Termination::converged);
    EXPECT_EQ(outcome.iterations.size(), 2u);
    const IterationRecord& first = outcome.iterations.front();
    EXPECT_LT(std::min(first.rotation_step_rad, first.translation_step), 1e-9);
  }
  EXPECT_EQ(run(still).iterations.size(), 1u);
}

TEST(IgspLoop, StopsAtTheLastIteration) {
  const Pair pair = half_clutter(5, 200, any_motion(5));
  LoopSchedule schedule;
  schedule.max_iterations = 1;
  const LoopOutcome outcome = run(pair, loop_options(), schedule);
  EXPECT_EQ(outcome.termination, Termination::max_iterations);
  EXPECT_EQ(outcome.iterations.size(), 1u);
  EXPECT_TRUE(outcome.has_estimate);
}

TEST(IgspLoop, StartsFromTheGivenPose) {
  const Pair pair = half_clutter(6, 200, any_motion(6));
  const Transformation initial = any_motion(60);
  const LoopOutcome outcome = run(pair, loop_options(), {}, initial);
  EXPECT_LT(error(outcome.target_from_source, pair.truth), 1e-9);
  const IterationRecord& first = outcome.iterations.front();
  EXPECT_NEAR(first.rotation_step_rad, rotation_error_rad(first.target_from_source.linear(), initial.linear()), 1e-9);
}

TEST(IgspLoop, NeedsThreeKeypointsOnEitherSide) {
  Pair pair = half_clutter(7, 20, any_motion(7));
  pair.target.resize(2);
  pair.target_descriptors.resize(2);
  for (int side = 0; side < 2; ++side) {
    const LoopOutcome outcome = run(pair);
    EXPECT_EQ(outcome.termination, Termination::too_few_keypoints);
    EXPECT_FALSE(outcome.has_estimate);
    EXPECT_TRUE(outcome.iterations.empty());
    std::swap(pair.source, pair.target);
    pair.source_variants = sign_variants(pair.target_descriptors, 4);
    pair.target_descriptors.assign(20, Descriptor{});
  }
  EXPECT_EQ(run(Pair{}).termination, Termination::too_few_keypoints);
}

// Nothing is alike: at mean minus 2.5 sigma of random descriptors, and no more, nothing comes near.
TEST(IgspLoop, EndsWhenTooFewMatch) {
  Random random(8);
  Pair pair;
  std::vector<Descriptor> own;
  for (int i = 0; i < 6; ++i) {
    pair.source.push_back(random.in_cube(3));
    pair.target.push_back(random.in_cube(3));
    own.push_back(testing::random_descriptor(random));
    pair.target_descriptors.push_back(testing::random_descriptor(random));
  }
  pair.source_variants = sign_variants(own, 4);
  const LoopOutcome outcome = run(pair);
  EXPECT_EQ(outcome.termination, Termination::too_few_matches);
  EXPECT_FALSE(outcome.has_estimate);
  ASSERT_EQ(outcome.iterations.size(), 1u);
  EXPECT_LT(outcome.iterations[0].matches, 3u);
}

TEST(IgspLoop, EndsWhenTheMatchesLieOnALine) {
  Pair pair = half_clutter(9, 100, Transformation::Identity());
  for (std::size_t i = 0; i < 100; ++i) pair.source[i] = pair.target[i] = Eigen::Vector3d(0.1 * i, 0.2 * i, 0.3 * i);
  const LoopOutcome outcome = run(pair);
  EXPECT_EQ(outcome.termination, Termination::degenerate_matches);
  EXPECT_FALSE(outcome.has_estimate);
  EXPECT_EQ(outcome.target_from_source.matrix(), Eigen::Matrix4d::Identity());
  ASSERT_EQ(outcome.iterations.size(), 1u);
  EXPECT_GE(outcome.iterations[0].matches, 3u);
}

TEST(IgspLoop, TicksOnceAnIterationAndMayBeStopped) {
  const Pair pair = half_clutter(10, 100, any_motion(10));
  LoopSchedule schedule;
  schedule.first_k = 2;
  std::vector<int> ticks;
  const LoopOutcome outcome = igsp_loop(pair.input(), Transformation::Identity(), schedule, loop_options(),
                                        [&](int iteration) { ticks.push_back(iteration); });
  ASSERT_EQ(ticks.size(), outcome.iterations.size());
  for (std::size_t i = 0; i < ticks.size(); ++i) EXPECT_EQ(ticks[i], static_cast<int>(i)) << "counted from 0";
  const auto stopped = [](int iteration) {
    if (iteration == 1) throw Cancelled();
  };
  EXPECT_THROW(igsp_loop(pair.input(), Transformation::Identity(), {}, loop_options(), stopped), Cancelled);
}

TEST(IgspLoop, IsBitIdenticalForEveryThreadCount) {
  const Pair pair = half_clutter(11, 300, any_motion(11));
  Options options = loop_options();
  const LoopOutcome one = run(pair, options);
  for (const int threads : {2, 4}) {
    options.threads = threads;
    const LoopOutcome many = run(pair, options);
    EXPECT_EQ(many.target_from_source.matrix(), one.target_from_source.matrix());
    ASSERT_EQ(many.iterations.size(), one.iterations.size());
    for (std::size_t i = 0; i < one.iterations.size(); ++i) {
      EXPECT_EQ(many.iterations[i].energy, one.iterations[i].energy);
      EXPECT_EQ(many.iterations[i].t_cd, one.iterations[i].t_cd);
    }
  }
}

}  // namespace
}  // namespace igsp
