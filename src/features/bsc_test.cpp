#include "features/bsc.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "features/features_testing.hpp"
#include "features/reference_frame.hpp"

namespace igsp {
namespace {

using testing::bit_of;
using testing::differing_bits;
using testing::Random;
using testing::random_support;
using testing::support_of;
using testing::surface_support;

constexpr double radius = 2.0;

// --- Flips ---

RC_GTEST_PROP(Bsc, FlippedEqualsRecomputedInTheFlippedFrame, (std::uint64_t seed)) {
  Random random(seed);
  const Points points = random.integer(0, 1) == 0 ? random_support(random, random.integer(0, 300), radius)
                                                  : surface_support(random, 600, radius);
  const Support support = support_of(points);
  const Eigen::Matrix3d frame = random.rotation();
  const Descriptor descriptor = binary_shape_context(support, frame, radius);
  for (int flip = 0; flip < 4; ++flip) {
    const Descriptor recomputed = binary_shape_context(support, testing::with_signs(frame, flip), radius);
    RC_ASSERT(differing_bits(flipped(descriptor, flip), recomputed) == 0);
  }
}

TEST(Bsc, FlippedEqualsRecomputedInOwnFrames) {
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Support support = support_of(surface_support(random, 1500, radius));
    const Eigen::Matrix3d own = reference_frame(support, radius), levelled = levelled_reference_frame(support, radius);
    const Descriptor in_own = binary_shape_context(support, own, radius);
    const Descriptor in_levelled = binary_shape_context(support, levelled, radius);
    for (int flip = 0; flip < 4; ++flip) {
      EXPECT_EQ(flipped(in_own, flip), binary_shape_context(support, testing::with_signs(own, flip), radius));
      if (flip >= 2) continue;  // levelled frames have two variants
      EXPECT_EQ(flipped(in_levelled, flip), binary_shape_context(support, testing::with_signs(levelled, flip), radius));
    }
  }
}

// Coordinates on the borders of cells, where rounding decides, are flipped exactly as well.
TEST(Bsc, FlippedEqualsRecomputedOnTheBordersOfCells) {
  Random random(2);
  const double u = 2 * 3.5 / bsc::side;
  Points points;
  for (int i = 0; i < 300; ++i) {
    const int x = random.integer(-8, 8), y = random.integer(-8, 8);
    points.push_back(0.5 * u * Eigen::Vector3d(x, y, random.integer(-8, 8)));
  }
  const Descriptor descriptor = binary_shape_context(support_of(points), Eigen::Matrix3d::Identity(), 3.5);
  for (int flip = 0; flip < 4; ++flip) {
    const Eigen::Matrix3d frame = testing::with_signs(Eigen::Matrix3d::Identity(), flip);
    EXPECT_EQ(flipped(descriptor, flip), binary_shape_context(support_of(points), frame, 3.5)) << "flip " << flip;
  }
}

RC_GTEST_PROP(Bsc, FlipsFormTheKleinGroupAndKeepDistances, (std::uint64_t seed)) {
  Random random(seed);
  const Descriptor a = testing::random_descriptor(random), b = testing::random_descriptor(random);
  for (int f = 0; f < 4; ++f) {
    RC_ASSERT(differing_bits(flipped(a, f), flipped(b, f)) == differing_bits(a, b));
    for (int g = 0; g < 4; ++g) RC_ASSERT(flipped(flipped(a, f), g) == flipped(a, f ^ g));
  }
  RC_ASSERT(flipped(a, 0) == a);
}

TEST(Bsc, SignVariantsAreTheFlipsRowByRow) {
  Random random(3);
  const std::vector<Descriptor> descriptors{testing::random_descriptor(random), testing::random_descriptor(random)};
  for (const int variants : {1, 2, 4}) {
    const std::vector<Descriptor> all = sign_variants(descriptors, variants);
    ASSERT_EQ(all.size(), 2u * variants);
    for (int i = 0; i < 2 * variants; ++i) EXPECT_EQ(all[i], flipped(descriptors[i / variants], i % variants));
  }
}

// --- What the bits mean ---

TEST(Bsc, PaddingStaysZero) {
  Random random(4);
  const std::uint64_t padding = ~std::uint64_t{0} << (bsc_bits % 64);
  for (int trial = 0; trial < 20; ++trial) {
    const Support support = support_of(random_support(random, 500, radius));
    const Descriptor d = binary_shape_context(support, random.rotation(), radius);
    for (const Descriptor& variant : sign_variants(std::span(&d, 1), 4)) EXPECT_EQ(variant.back() & padding, 0u);
  }
}

TEST(Bsc, OfNoPointsIsZero) {
  EXPECT_EQ(binary_shape_context(Support{}, Eigen::Matrix3d::Identity(), radius), Descriptor{});
}

// W is exp(-2 r^2) with r in cells and rho = W pi 49 / 4: 38 in the cell itself, 5 beside it, 0.7 at its corners.
TEST(Bsc, OfThePointItselfOccupiesNineCellsAPlane) {
  const Descriptor d = binary_shape_context(support_of(Points{{0, 0, 0}}), Eigen::Matrix3d::Identity(), radius);
  for (int plane = 0; plane < bsc::planes; ++plane) {
    for (int j = -bsc::half; j <= bsc::half; ++j) {
      for (int i = -bsc::half; i <= bsc::half; ++i) {
        const bool expected = std::abs(i) <= 1 && std::abs(j) <= 1;
        EXPECT_EQ(bit_of(d, plane * bsc::cells + bsc::cell_number(i, j)), expected) << plane << ": " << i << ", " << j;
      }
    }
  }
  for (int bit = bsc::depth_begin; bit < bsc::density_begin; ++bit) EXPECT_FALSE(bit_of(d, bit)) << "all depths are 0";
}

// A point at (2, -3, 1) cells lies there in XY, at (2, 1) in XZ and at (-3, 1) in YZ.
TEST(Bsc, PlanesAreXyXzAndYz) {
  const double u = 2 * radius / bsc::side;
  Random random(5);
  const Eigen::Matrix3d frame = random.rotation();
  const Descriptor d = binary_shape_context(support_of(Points{frame * Eigen::Vector3d(2, -3, 1) * u}), frame, radius);
  constexpr int cell[3][2] = {{2, -3}, {2, 1}, {-3, 1}};
  for (int plane = 0; plane < bsc::planes; ++plane) {
    for (int j = -bsc::half; j <= bsc::half; ++j) {
      for (int i = -bsc::half; i <= bsc::half; ++i) {
        const bool expected = std::abs(i - cell[plane][0]) <= 1 && std::abs(j - cell[plane][1]) <= 1;
        EXPECT_EQ(bit_of(d, plane * bsc::cells + bsc::cell_number(i, j)), expected) << plane << ": " << i << ", " << j;
      }
    }
  }
}

// --- Against METHOD.md section 2 in plain double precision, without tables ---

struct PlaneMaps {
  double density[bsc::cells] = {};  // rho
  double depth[bsc::cells] = {};    // signed, 0 in empty cells
  bool empty[bsc::cells] = {};
};

PlaneMaps reference_maps(const Points& support, const Eigen::Matrix3d& frame, int plane) {
  constexpr int axes[3][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}};  // in the plane, in the plane, depth
  const double u = 2 * radius / bsc::side;
  PlaneMaps maps;
  for (int cell = 0; cell < bsc::cells; ++cell) {
    const double centre_a = (cell % bsc::side + 0.5) * u - radius, centre_b = (cell / bsc::side + 0.5) * u - radius;
    double weight = 0, weighted_depth = 0;
    for (const Eigen::Vector3d& point : support) {
      const Eigen::Vector3d local = frame.transpose() * point;
      const double distance = std::hypot(local[axes[plane][0]] - centre_a, local[axes[plane][1]] - centre_b);
      if (distance > 1.5 * u) continue;
      const double g = std::exp(-distance * distance / (2 * (u / 2) * (u / 2)));
      weight += g;
      weighted_depth += g * local[axes[plane][2]];
    }
    const double mean_density = static_cast<double>(support.size()) / (M_PI * radius * radius);
    maps.density[cell] = weight / (u * u) / mean_density;
    maps.depth[cell] = weight > 0 ? weighted_depth / weight : 0;
    maps.empty[cell] = weight == 0;
  }
  return maps;
}

/// (|delta - mean| - sigma) / sigma of every pair: positive where the bit is set.
std::array<double, bsc::pairs> reference_excess(const double* value) {
  double mean = 0, variance = 0;
  for (const auto& [p, q] : bsc::pair_table) mean += (value[p] - value[q]) / bsc::pairs;
  for (const auto& [p, q] : bsc::pair_table) variance += std::pow(value[p] - value[q] - mean, 2) / bsc::pairs;
  std::array<double, bsc::pairs> excess;
  for (int k = 0; k < bsc::pairs; ++k) {
    const auto& [p, q] = bsc::pair_table[k];
    excess[k] = std::abs(value[p] - value[q] - mean) / std::sqrt(variance) - 1;
  }
  return excess;
}

struct Agreement {
  long occupancy = 0, occupancy_away = 0, comparison = 0;  // differing bits
  long away = 0, descriptors = 0;
};

void compare_with_reference(const Points& support, const Eigen::Matrix3d& frame, Agreement& agreement) {
  const Descriptor descriptor = binary_shape_context(support_of(support), frame, radius);
  ++agreement.descriptors;
  for (int plane = 0; plane < bsc::planes; ++plane) {
    const PlaneMaps maps = reference_maps(support, frame, plane);
    for (int cell = 0; cell < bsc::cells; ++cell) {
      const bool differs = bit_of(descriptor, plane * bsc::cells + cell) != (maps.density[cell] > 0.1);
      agreement.occupancy += differs;
      if (std::abs(maps.density[cell] - 0.1) < 0.01) continue;
      ++agreement.away;
      agreement.occupancy_away += differs;
    }
    const auto depth = reference_excess(maps.depth), density = reference_excess(maps.density);
    for (int k = 0; k < bsc::pairs; ++k) {
      const auto& [p, q] = bsc::pair_table[k];
      const bool dense = density[k] > 0 && !(maps.empty[p] && maps.empty[q]);
      agreement.comparison += bit_of(descriptor, bsc::depth_begin + plane * bsc::pairs + k) != (depth[k] > 0);
      agreement.comparison += bit_of(descriptor, bsc::density_begin + plane * bsc::pairs + k) != dense;
    }
  }
}

// The code tabulates weights over 1/16 of a cell and cuts them at 1.5 u of the tabulated place. Measured: 99.43 % of
// the bits agree, nearly all others are comparison bits, and all occupancy bits away from their threshold agree.
TEST(Bsc, AgreesWithThePlainSpecification) {
  Random random(6);
  Agreement agreement;
  for (int trial = 0; trial < 60; ++trial) {
    const bool surface = trial % 2 == 0;
    const Points support = surface ? surface_support(random, 900, radius) : random_support(random, 300, radius);
    const Eigen::Matrix3d frame = surface ? reference_frame(support_of(support), radius) : random.rotation();
    compare_with_reference(support, frame, agreement);
  }
  const double differing = agreement.occupancy + agreement.comparison, all = 435.0 * agreement.descriptors;
  EXPECT_GT(1 - differing / all, 0.98);
  EXPECT_GT(agreement.away, 100 * agreement.descriptors);
  EXPECT_EQ(agreement.occupancy_away, 0);
}

// In the centres of cells the tabulated weights are exact, and so is every comparison, but for what is equal to sigma.
TEST(Bsc, ComparesWithSigmaAboutTheMeanOfAllPairs) {
  Random random(12);
  const double u = 2 * radius / bsc::side;
  int wrong = 0, compared = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Points points;
    for (int place = 0; place < 12; ++place) {
      const Eigen::Vector3d cell(random.integer(-3, 3), random.integer(-3, 3), random.integer(-3, 3));
      points.resize(points.size() + (std::size_t{1} << random.integer(0, 5)), u * cell);
    }
    const Descriptor descriptor = binary_shape_context(support_of(points), Eigen::Matrix3d::Identity(), radius);
    for (int plane = 0; plane < bsc::planes; ++plane) {
      const PlaneMaps maps = reference_maps(points, Eigen::Matrix3d::Identity(), plane);
      const auto depth = reference_excess(maps.depth), density = reference_excess(maps.density);
      for (int k = 0; k < bsc::pairs; ++k) {
        const auto& [p, q] = bsc::pair_table[k];
        const bool one_is_occupied = !(maps.empty[p] && maps.empty[q]);
        for (const auto& [first, excess] : {std::pair(bsc::depth_begin, depth[k]), {bsc::density_begin, density[k]}}) {
          if (std::abs(excess) < 0.01 || (first == bsc::density_begin && !one_is_occupied)) continue;
          ++compared;
          wrong += bit_of(descriptor, first + plane * bsc::pairs + k) != (excess > 0);
        }
      }
    }
  }
  EXPECT_GT(compared, 5000);
  EXPECT_EQ(wrong, 0);
}

// Where most differences lean one way, no difference at all stands out from their mean; between empty cells it says
// nothing. A least-squares search has found this support.
TEST(Bsc, TwoEmptyCellsDoNotDiffer) {
  constexpr int places[][5] = {{0, -2, -4, 4, 2},   {0, 2, -4, -4, 4}, {2, 0, 4, 0, 9},    {-3, 0, 4, 0, 4},
                               {0, -4, 0, -4, 102}, {0, 4, 0, 4, 104}, {-1, -1, 4, -4, 5}, {-1, 1, 4, 4, 4},
                               {1, -2, -4, 4, 8},   {-2, 0, 4, 0, 6},  {1, 1, -4, 4, 5}};
  const double u = 2 * radius / bsc::side;
  Points points;
  for (const auto& [i, j, steps_i, steps_j, count] : places) {  // cell, sixteenths of it, how many
    points.resize(points.size() + count, u * Eigen::Vector3d(i + steps_i / 16.0, j + steps_j / 16.0, 0));
  }
  const Descriptor descriptor = binary_shape_context(support_of(points), Eigen::Matrix3d::Identity(), radius);
  const PlaneMaps maps = reference_maps(points, Eigen::Matrix3d::Identity(), 0);
  const auto excess = reference_excess(maps.density);
  int empty_pairs = 0;
  for (int k = 0; k < bsc::pairs; ++k) {
    const auto& [p, q] = bsc::pair_table[k];
    if (!maps.empty[p] || !maps.empty[q]) continue;
    ++empty_pairs;
    EXPECT_GT(excess[k], 0.05) << "or the test asks nothing";
    EXPECT_FALSE(bit_of(descriptor, bsc::density_begin + k)) << k;
  }
  EXPECT_GT(empty_pairs, 0);
}

// --- Invariance ---

TEST(Bsc, DoesNotChangeUnderARigidMotionUpToSigns) {
  Random random(7);
  for (int trial = 0; trial < 30; ++trial) {
    const Points points = surface_support(random, 4000, radius);
    Transformation turn = Transformation::Identity();
    turn.linear() = random.rotation();
    const Support here = support_of(points), there = support_of(testing::moved(turn, points));
    const Descriptor a = binary_shape_context(here, reference_frame(here, radius), radius);
    const Descriptor b = binary_shape_context(there, reference_frame(there, radius), radius);
    int least = bsc_bits;
    for (int flip = 0; flip < 4; ++flip) least = std::min(least, differing_bits(flipped(a, flip), b));
    EXPECT_LE(least, 4) << "measured: 0";
  }
}

TEST(Bsc, DoesNotDependOnTheUnitOfLength) {
  Random random(8);
  const Points points = surface_support(random, 1000, radius);
  Points larger = points;
  for (Eigen::Vector3d& point : larger) point *= 1024;
  const Eigen::Matrix3d frame = random.rotation();
  EXPECT_EQ(binary_shape_context(support_of(points), frame, radius),
            binary_shape_context(support_of(larger), frame, 1024 * radius));
}

TEST(Bsc, TellsOneSurfaceFromAnother) {
  Random random(9);
  std::vector<Descriptor> descriptors;
  for (int i = 0; i < 20; ++i) {
    const Support support = support_of(surface_support(random, 2000, radius));
    descriptors.push_back(binary_shape_context(support, reference_frame(support, radius), radius));
  }
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT(differing_bits(descriptors[i], descriptors[j]), 30);
  }
}

// --- Many places ---

TEST(Bsc, InCommonFramesIsTheSameForEveryThreadCount) {
  Random random(10);
  const testing::BumpySurface shape(random);
  const Points points = shape.sample(random, 8000, 6);
  const PointGrid grid(points, 1.0);
  const Points places(points.begin(), points.begin() + 200);
  const SupportTable supports = gather_supports(grid, places, radius);
  ASSERT_EQ(supports.size(), places.size());
  const std::vector<Eigen::Matrix3d> frames{random.rotation(), random.rotation(), random.rotation()};
  const auto described = [&](int threads, std::initializer_list<EveryNth> parts) {
    std::vector<std::vector<Descriptor>> descriptors(frames.size());
    std::vector<std::vector<Descriptor>*> of_frames;
    for (auto& of_frame : descriptors) of_frames.push_back(&of_frame);
    for (const EveryNth& part : parts) describe_in_frames(supports, part, frames, radius, threads, of_frames);
    return descriptors;
  };
  const auto found = described(1, {{}});
  for (std::size_t k = 0; k < frames.size(); ++k) {
    ASSERT_EQ(found[k].size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      Support support;
      gather_support(grid, places[i], radius, support);
      EXPECT_EQ(found[k][i], binary_shape_context(support, frames[k], radius));
    }
  }
  for (const int threads : {0, 2, 4}) EXPECT_EQ(described(threads, {{}}), found);
  EXPECT_EQ(described(2, {{.step = 7}, {.step = 1, .but_not = 7}}), found);
  const auto some = described(1, {{.step = 7}});
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(some[1][i], i % 7 == 0 ? found[1][i] : Descriptor{});
}

TEST(Support, HoldsThePointsWithinItsReach) {
  Random random(11);
  const Points points = testing::random_points(random, 2000, 6);
  const PointGrid grid(points, 0.7);
  Support support;
  for (int trial = 0; trial < 20; ++trial) {  // the same buffers again and again
    const Eigen::Vector3d keypoint = random.in_cube(7);
    gather_support(grid, keypoint, radius, support);
    std::size_t expected = 0;
    for (const Eigen::Vector3d& point : points) {
      expected += (point.cast<float>() - keypoint.cast<float>()).norm() <= static_cast<float>(std::sqrt(3.0) * radius);
    }
    ASSERT_EQ(support.size(), expected);
    for (std::size_t i = 0; i < support.size(); ++i) {
      const Eigen::Vector3f offset(support.x[i], support.y[i], support.z[i]);
      EXPECT_LE(offset.norm(), std::sqrt(3.0) * radius * (1 + 1e-6));
      EXPECT_GE(grid.nearest(keypoint.cast<float>() + offset, 1e-5f), 0);
    }
  }
}

}  // namespace
}  // namespace igsp
