// Pairs that a registration must refuse, must call ambiguous, or must get right although much speaks against it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes.hpp"
#include "simulation/random.hpp"

namespace igsp {
namespace {

using simulation::Random;
using testing::disagreement;
using testing::Pair;

constexpr double right = 1.0;  // displacement of the source [voxels]; the right answers below are within 0.4

Pair scrambled_pair(std::string_view scene, int points, std::uint64_t seed) {
  return testing::scrambled(testing::simulated_pair(scene, points, 0.0, seed), seed);
}

bool is_right(const Result& result, const Pair& pair) {
  return result.has_estimate &&
         disagreement(result.target_from_source, pair.truth, pair.source) < right * result.voxel_size;
}

void expect_right(const Pair& pair) {
  const Result result = align(pair.source, pair.target);
  EXPECT_TRUE(result.registered) << result.reason;
  EXPECT_LT(disagreement(result.target_from_source, pair.truth, pair.source), right * result.voxel_size);
}

void expect_right_or_refused(const Pair& pair) {
  const Result result = align(pair.source, pair.target);
  EXPECT_TRUE(!result.registered || is_right(result, pair)) << result.confidence << ": " << result.reason;
}

// Whatever the matches say, which see how each cloud is sampled.
TEST(HardScenes, SquareRoomsAreRefused) {
  for (const int points : {2000, 20000}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(::testing::Message() << points << " points, seed " << seed);
      const Pair pair = scrambled_pair("square_room", points, seed);
      const Result result = align(pair.source, pair.target);
      EXPECT_FALSE(result.registered) << result.confidence << ": " << result.reason;
    }
  }
}

// What a lidar of 16 lines sees of a scene, of all that a terrestrial scanner does: every 2 degrees 0.2 of them.
Points in_sixteen_lines(const Points& points) {
  constexpr double step = 2, lowest = -15, width = 0.2;
  Points seen;
  for (const Eigen::Vector3d& point : points) {
    const double elevation = std::atan2(point.z(), point.head<2>().norm()) * 180 / EIGEN_PI;
    const double line = std::round((elevation - lowest) / step);
    if (line >= 0 && line < 16 && std::abs(elevation - lowest - step * line) < 0.5 * width) seen.push_back(point);
  }
  return seen;
}

// Lines of one scan lie between those of the other: no voxel of a line's width has a surface, or is met.
TEST(HardScenes, SixteenLinesOfAParkAreRegisteredToAFractionOfAVoxel) {
  for (const std::uint64_t seed : {3, 4, 7, 8, 12}) {
    SCOPED_TRACE(seed);
    Pair pair = testing::simulated_pair("park", 400000, 0, seed);
    pair.source = in_sixteen_lines(pair.source);
    pair.target = in_sixteen_lines(pair.target);
    const Result result = align(pair.source, pair.target);
    EXPECT_TRUE(result.registered) << result.confidence << ": " << result.reason;
    EXPECT_LT(disagreement(result.target_from_source, pair.truth, pair.source), 0.4 * result.voxel_size);
  }
}

// Four turns lay it on itself; at one of them the points coincide, and many more matches agree.
TEST(HardScenes, ALatticeOnItselfIsRefused) {
  Points lattice;
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 30; ++y) {
      for (int z = 0; z < 20; ++z) lattice.emplace_back(x, y, z);
    }
  }
  const Result result = align(lattice, lattice);
  EXPECT_FALSE(result.registered) << result.confidence << ": " << result.reason;
  EXPECT_NE(result.reason.find("ambiguous"), std::string::npos) << result.reason;
}

// A seat and two legs, sampled all around; points a square metre.
Points bench(double density, std::uint64_t seed) {
  struct Box {
    Eigen::Vector3d centre, size;
  };
  const std::array<Box, 3> boxes{
      {{{0, 0, 0.44}, {1.5, 0.4, 0.05}}, {{-0.6, 0, 0.21}, {0.08, 0.36, 0.42}}, {{0.6, 0, 0.21}, {0.08, 0.36, 0.42}}}};
  Random random(seed);
  Points sampled;
  for (const auto& [centre, size] : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < density * 2 * size.prod() / size[axis]; ++i) {
        Eigen::Vector3d place{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
        place[axis] = std::copysign(0.5, place[axis]);
        sampled.push_back(centre + place.cwiseProduct(size));
      }
    }
  }
  return sampled;
}

// The half does not lie on itself after a turn; the whole does, and so the half fits on either end of it.
TEST(HardScenes, HalfABenchIsNotRegisteredToTheWhole) {
  for (const double density : {1219.5, 4878.0}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      Points half = bench(density, seed);
      std::erase_if(half, [](const Eigen::Vector3d& point) { return point.x() < -0.05; });
      const Pair pair = testing::scrambled({bench(density, 100 + seed), half}, seed);
      for (const Result& result : {align(pair.source, pair.target), align(pair.target, pair.source)}) {
        SCOPED_TRACE(::testing::Message() << density << " points a square metre, seed " << seed);
        EXPECT_FALSE(result.registered) << result.confidence << ": " << result.reason;
      }
    }
  }
}

TEST(HardScenes, RepetitiveCorridorIsNeverWrong) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    expect_right_or_refused(scrambled_pair("repetitive_corridor", 20000, seed));
  }
}

// Of 800 such pairs three were registered, at 0.57 to 0.83; these two slide on themselves.
TEST(HardScenes, EqualDoorsFixNoCorridor) {
  for (const std::uint64_t seed : {64, 347}) {
    SCOPED_TRACE(seed);
    SimulationOptions options;
    options.points = 12000;
    options.seed = seed;
    options.noise = 0.005;
    const std::vector<SimulatedScan> scans = simulate("repetitive_corridor", options);
    const Result result = align(scans[0].points, scans[1].points);
    EXPECT_FALSE(result.registered) << result.confidence << ": " << result.reason;
    EXPECT_NE(result.reason.find("not fixed by the surfaces: translation along"), std::string::npos) << result.reason;
  }
}

// Floor and walls lie right in a mirror, and where nothing is contradicted the known viewpoints speak for the pose.
TEST(HardScenes, MirroredSourceIsRefused) {
  for (const char* scene : {"park", "indoor"}) {
    for (const std::uint64_t seed : {1, 2, 6, 7}) {
      SCOPED_TRACE(::testing::Message() << scene << " " << seed);
      Pair pair = testing::simulated_pair(scene, 60000, 0, seed);
      for (Eigen::Vector3d& point : pair.source) point.y() *= -1;
      const Result result =
          align(Scan{pair.source, Eigen::Vector3d::Zero()}, Scan{pair.target, Eigen::Vector3d::Zero()});
      EXPECT_FALSE(result.registered) << result.confidence << ": " << result.reason;
    }
  }
}

void expect_refusal(const Points& source, const Points& target) {
  const Result result = align(source, target);
  EXPECT_FALSE(result.registered) << result.confidence << ": " << result.reason;
  EXPECT_FALSE(result.reason.empty());
}

TEST(HardScenes, NoiseIsRefused) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const Pair same_box = scrambled_pair("noise", 20000, seed);
    expect_refusal(same_box.source, same_box.target);
    expect_refusal(same_box.source, scrambled_pair("noise", 20000, seed + 100).target);
    expect_refusal(same_box.source, scrambled_pair("park", 20000, seed).target);
  }
}

TEST(HardScenes, TwoDifferentScenesAreRefused) {
  constexpr const char* pairs[][2] = {
      {"park", "park"}, {"indoor", "indoor"}, {"object", "object"}, {"park", "indoor"}, {"indoor", "square_room"}};
  for (const auto& [source, target] : pairs) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(::testing::Message() << source << " and " << target << ", seed " << seed);
      expect_refusal(scrambled_pair(source, 20000, seed).source, scrambled_pair(target, 20000, seed + 100).target);
    }
  }
}

/// The share of the points that is nearest to `place`.
Points ball(Points points, const Eigen::Vector3d& place, double share) {
  const auto end = points.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(points.size()));
  const auto is_nearer = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - place).squaredNorm() < (b - place).squaredNorm();
  };
  std::nth_element(points.begin(), end, points.end(), is_nearer);
  return {points.begin(), end};
}

/// A point of the cloud where there is something to recognise: above the floor, at middle distance from the sensor.
Eigen::Vector3d some_place(const Points& points, Random& random) {
  const double size = testing::radius_of_gyration(points);
  const Eigen::Vector3d centre = testing::centroid(points);
  for (;;) {
    const Eigen::Vector3d& place = points[random.bits() % points.size()];
    if ((place - centre).norm() < size && place.z() > centre.z()) return place;
  }
}

/// Every second point of a scan, and a ball cut out of the others: no point is in both, as in two scans.
Pair ball_in_scan(std::string_view scene, double share, std::uint64_t seed) {
  const Points scan = testing::simulated_pair(scene, 80000, 0.0, seed).target;
  Points even, odd;
  for (std::size_t i = 0; i < scan.size(); ++i) (i % 2 == 0 ? even : odd).push_back(scan[i]);
  Random random(seed);
  return testing::scrambled({ball(odd, some_place(odd, random), share), even}, seed);
}

TEST(HardScenes, IdenticalClouds) {
  for (const char* scene : {"park", "indoor", "object"}) {
    SCOPED_TRACE(scene);
    const Points cloud = testing::simulated_pair(scene, 40000).target;
    const Result still = align(cloud, cloud);
    ASSERT_TRUE(still.registered) << still.reason;
    EXPECT_LT(disagreement(still.target_from_source, Transformation::Identity(), cloud), 1e-6 * still.voxel_size);

    // Moved, the voxel grid lies elsewhere, and its centroids with it: seen up to 0.007.
    const Pair pair = testing::scrambled({cloud, cloud}, 1);
    const Result result = align(pair.source, pair.target);
    ASSERT_TRUE(result.registered) << result.reason;
    EXPECT_LT(disagreement(result.target_from_source, pair.truth, pair.source), 0.02 * result.voxel_size);
  }
}

Points thinned(const Points& points, double share, Random random) {
  Points kept;
  for (const Eigen::Vector3d& point : points)
    if (random.chance(share)) kept.push_back(point);
  return kept;
}

/// 400,000 points against 8,000, either way. The park's 8,000 points lie too far apart for its trees to be recognised
/// every time, so there a refusal is an answer.
TEST(HardScenes, DensityRatioOfFifty) {
  for (const char* scene : {"indoor", "object", "park"}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      SCOPED_TRACE(::testing::Message() << scene << " " << seed);
      const Pair pair = scrambled_pair(scene, 400000, seed);
      const Pair thin_source{thinned(pair.source, 0.02, Random(seed)), pair.target, pair.truth};
      const Pair thin_target{pair.source, thinned(pair.target, 0.02, Random(seed)), pair.truth};
      const bool may_refuse = std::string_view(scene) == "park";
      may_refuse ? expect_right_or_refused(thin_source) : expect_right(thin_source);
      may_refuse ? expect_right_or_refused(thin_target) : expect_right(thin_target);
    }
  }
}

/// Adds uniform random points of the bounding box, `share` of the cloud's number.
void add_outliers(Points& points, double share, Random& random) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  const auto count = static_cast<std::size_t>(share * static_cast<double>(points.size()));
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d u{random.uniform(), random.uniform(), random.uniform()};
    points.push_back(box.min() + u.cwiseProduct(box.sizes()));
  }
}

TEST(HardScenes, OutliersOfThirtyPercent) {
  for (const char* scene : {"park", "indoor", "object"}) {
    for (const int points : {50000, 100000}) {
      SCOPED_TRACE(::testing::Message() << scene << " " << points);
      Pair pair = scrambled_pair(scene, points, 1);
      Random random(1);
      add_outliers(pair.source, 0.3, random);
      add_outliers(pair.target, 0.3, random);
      expect_right(pair);
    }
  }
}

// One of the nine is refused: 10 of 19 matches agree, 8 with the runner-up.
TEST(HardScenes, SourceInsideTheTarget) {
  int registered = 0;
  for (const char* scene : {"park", "indoor", "object"}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(::testing::Message() << scene << " " << seed);
      const Pair pair = ball_in_scan(scene, 0.3, seed);
      const Result result = align(pair.source, pair.target);
      EXPECT_TRUE(is_right(result, pair)) << result.reason;
      registered += result.registered;
    }
  }
  EXPECT_GE(registered, 8);
}

}  // namespace
}  // namespace igsp
