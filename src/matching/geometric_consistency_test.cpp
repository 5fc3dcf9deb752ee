#include "matching/geometric_consistency.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numbers>

#include "core/core_testing.hpp"

namespace igsp {
namespace {

using testing::Random;

struct Scene {
  Points source, target;
  std::vector<Candidate> candidates;
  ConsistencyOptions options;
};

/// Half of the candidates follow one motion within a few tolerances, the others follow nothing.
Scene random_scene(std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  scene.options.length_tolerance = random.uniform(0.2, 2);
  scene.options.min_length = random.uniform(2, 4) * scene.options.length_tolerance;
  scene.options.max_angle_rad = random.uniform(0.1, 3);
  const std::size_t size = random.integer(0, 150);
  scene.source = testing::random_points(random, size, 10);
  scene.target = testing::random_points(random, size, 10);
  const Transformation truth = random.motion(5);
  for (std::uint32_t i = 0; i < size; ++i) {
    Eigen::Quaterniond rotation(random.rotation());
    if (i % 2 == 0) {
      scene.target[i] = truth * scene.source[i] + random.in_cube(scene.options.length_tolerance);
      const Eigen::AngleAxisd error(random.uniform(0, scene.options.max_angle_rad), random.direction());
      rotation = Eigen::Quaterniond(Eigen::Matrix3d(error * truth.linear()));
    }
    if (random.integer(0, 1) == 0) rotation.coeffs() *= -1;  // the same rotation
    scene.candidates.push_back({i, static_cast<std::uint32_t>(random.integer(0, 9) == 0 ? random.bits() % size : i), 0,
                                rotation.cast<float>()});
  }
  return scene;
}

/// How much room two candidates have before they stop to agree, [units of the cloud], radians and a cosine; positive:
/// they agree.
struct Margins {
  double length, long_enough, angle, direction;
};

Margins margins(const Scene& scene, std::size_t c, std::size_t d) {
  const Candidate &x = scene.candidates[c], &y = scene.candidates[d];
  const Eigen::Vector3d from = scene.source[x.source] - scene.source[y.source];
  const Eigen::Vector3d to = scene.target[x.target] - scene.target[y.target];
  const double a = from.norm(), b = to.norm();
  const Eigen::Quaterniond p = x.target_from_source.cast<double>(), q = y.target_from_source.cast<double>();
  const double along = to.dot(p.slerp(0.5, q) * from) / std::max(1e-12, a * b);
  return {scene.options.length_tolerance - std::abs(a - b), std::min(a, b) - scene.options.min_length,
          scene.options.max_angle_rad - 2 * std::acos(std::min(1.0, std::abs(p.dot(q)))),
          along - std::cos(0.75 * scene.options.max_angle_rad)};
}

ConsistencyGraph graph_of(const Scene& scene, int threads = 1) {
  return consistency_graph(scene.candidates, scene.source, scene.target, scene.options, threads);
}

constexpr double rounding = 1e-4;  // single precision

// The code tests (a^2 - b^2)^2 < tol^2 (a^2 + b^2 + 2 min(a^2, b^2)) to save two square roots. It is never looser than
// | a - b | < tol, and tighter by no more than tol^2 / (4 min(a, b)): second order in the tolerance.
RC_GTEST_PROP(ConsistencyGraph, EqualsAPlainDoubleLoopWithinItsStatedTolerance, (std::uint64_t seed)) {
  const Scene scene = random_scene(seed);
  const ConsistencyGraph graph = graph_of(scene);
  RC_ASSERT(graph.size() == scene.candidates.size());
  const double tolerance = scene.options.length_tolerance;
  for (std::size_t c = 0; c < graph.size(); ++c) {
    for (std::size_t d = 0; d < graph.size(); ++d) {
      const Margins m = margins(scene, c, d);
      const double shorter = scene.options.min_length + m.long_enough;
      const double slack = shorter > 0 ? tolerance * tolerance / (4 * shorter) : tolerance;
      const bool certainly =
          m.length > slack + rounding && m.long_enough > rounding && m.angle > rounding && m.direction > rounding;
      const bool certainly_not =
          m.length < -rounding || m.long_enough < -rounding || m.angle < -rounding || m.direction < -rounding;
      if (certainly) RC_ASSERT(graph.agree(c, d));
      if (certainly_not) RC_ASSERT(!graph.agree(c, d));
    }
  }
}

TEST(ConsistencyGraph, TheSlackOfTheLengthTestIsWhatItIsSaidToBe) {
  const double tolerance = 2;
  for (const double length : {4.0, 6.0, 20.0, 100.0}) {
    double largest = 0;  // difference of lengths that still agrees
    for (double difference = 0; difference < 1.1 * tolerance; difference += 0.001) {
      const Points source{{0, 0, 0}, {length + 1e-3, 0, 0}}, target{{0, 0, 0}, {length + 1e-3 + difference, 0, 0}};
      const std::vector<Candidate> candidates{{0, 0, 0, Eigen::Quaternionf::Identity()},
                                              {1, 1, 0, Eigen::Quaternionf::Identity()}};
      const ConsistencyGraph graph = consistency_graph(candidates, source, target, {tolerance, length, 0.1}, 1);
      if (graph.agree(0, 1)) largest = difference;
    }
    EXPECT_LT(largest, tolerance);
    EXPECT_GT(largest, tolerance - tolerance * tolerance / (4 * length) - 0.002) << "length " << length;
  }
}

// Lengths and frames alone would let half of all directions agree.
TEST(ConsistencyGraph, WhatPointsElsewhereDoesNotAgree) {
  const Points source{{0, 0, 0}, {10, 0, 0}};
  const std::vector<Candidate> candidates{{0, 0, 0, Eigen::Quaternionf::Identity()},
                                          {1, 1, 0, Eigen::Quaternionf::Identity()}};
  for (const double degrees : {0.0, 20.0, 32.0, 36.0, 90.0, 180.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const Points target{{0, 0, 0}, {10 * std::cos(angle), 10 * std::sin(angle), 0}};
    const ConsistencyOptions options{2, 4, 45 * std::numbers::pi / 180};
    EXPECT_EQ(consistency_graph(candidates, source, target, options, 1).agree(0, 1), degrees < 0.75 * 45) << degrees;
  }
}

RC_GTEST_PROP(ConsistencyGraph, IsSymmetricAndNobodyAgreesWithThemselves, (std::uint64_t seed)) {
  const ConsistencyGraph graph = graph_of(random_scene(seed));
  for (std::size_t c = 0; c < graph.size(); ++c) {
    RC_ASSERT(!graph.agree(c, c));
    for (std::size_t d = 0; d < c; ++d) RC_ASSERT(graph.agree(c, d) == graph.agree(d, c));
  }
}

RC_GTEST_PROP(ConsistencyGraph, CountsAndVisitsWhatAgrees, (std::uint64_t seed)) {
  const ConsistencyGraph graph = graph_of(random_scene(seed));
  for (std::size_t c = 0; c < std::min<std::size_t>(graph.size(), 30); ++c) {
    std::vector<std::size_t> neighbours, visited;
    for (std::size_t d = 0; d < graph.size(); ++d) {
      if (graph.agree(c, d)) neighbours.push_back(d);
    }
    graph.visit_neighbours(c, [&](std::size_t d) { visited.push_back(d); });
    RC_ASSERT(visited == neighbours);
    RC_ASSERT(graph.degree(c) == static_cast<int>(neighbours.size()));
    for (std::size_t d = 0; d < graph.size(); ++d) {
      const auto common =
          std::count_if(neighbours.begin(), neighbours.end(), [&](std::size_t e) { return graph.agree(d, e); });
      RC_ASSERT(graph.common_neighbours(c, d) == common);
    }
  }
}

TEST(ConsistencyGraph, IsTheSameForEveryThreadCount) {
  Random random(1);
  Scene scene = random_scene(77);
  for (std::uint32_t i = 0; scene.candidates.size() < 500; ++i) {
    Candidate copy = scene.candidates[i];
    copy.target = static_cast<std::uint32_t>(random.bits() % scene.target.size());
    scene.candidates.push_back(copy);
  }
  const ConsistencyGraph one = graph_of(scene, 1);
  for (const int threads : {2, 4}) {
    const ConsistencyGraph many = graph_of(scene, threads);
    for (std::size_t c = 0; c < one.size(); ++c) {
      EXPECT_TRUE(std::equal(one.row(c).begin(), one.row(c).end(), many.row(c).begin())) << threads << " threads";
    }
  }
}

}  // namespace
}  // namespace igsp
