#include "features/bsc_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "igsp/features.hpp"

namespace igsp::bsc {
namespace {

TEST(BscLayout, Has435Bits) {
  EXPECT_EQ(depth_begin, 147);
  EXPECT_EQ(density_begin, 147 + 144);
  EXPECT_EQ(bits, 435);
  EXPECT_EQ(bits, bsc_bits);
}

TEST(BscLayout, FrameFlipsAreTheProperSignChanges) {
  std::set<std::array<int, 3>> signs;
  for (const FrameFlip& flip : frame_flips) {
    EXPECT_EQ(flip.signs[0] * flip.signs[1] * flip.signs[2], 1);
    signs.insert(flip.signs);
  }
  EXPECT_EQ(signs.size(), 4u);
  EXPECT_EQ(frame_flips[0].signs, (std::array{1, 1, 1}));
  EXPECT_EQ(frame_flips[1].signs, (std::array{-1, -1, 1})) << "the one that levelled frames have";
}

TEST(BscLayout, SignsFlipTheCellsOfTheirPlane) {
  constexpr int in_plane[planes][2] = {{0, 1}, {0, 2}, {1, 2}};  // XY, XZ, YZ
  for (const FrameFlip& flip : frame_flips) {
    for (int plane = 0; plane < planes; ++plane) {
      const int expected =
          (flip.signs[in_plane[plane][0]] < 0 ? flip_i : none) | (flip.signs[in_plane[plane][1]] < 0 ? flip_j : none);
      EXPECT_EQ(flip.plane_flips[plane], expected) << "plane " << plane;
    }
  }
}

TEST(BscLayout, CellsFlipAboutTheCentre) {
  EXPECT_EQ(flipped_cell(cell_number(2, -1), flip_i), cell_number(-2, -1));
  EXPECT_EQ(flipped_cell(cell_number(2, -1), flip_j), cell_number(2, 1));
  EXPECT_EQ(flipped_cell(cell_number(2, -1), flip_both), cell_number(-2, 1));
  EXPECT_EQ(flipped_cell(cell_number(0, 0), flip_both), cell_number(0, 0));
}

TEST(BscLayout, PairsAreClosedUnderFlipsAsOrderedPairs) {
  std::set<std::pair<int, int>> unordered;
  for (int k = 0; k < pairs; ++k) {
    const auto [p, q] = pair_table[k];
    EXPECT_NE(p, q);
    EXPECT_TRUE(0 <= p && p < cells && 0 <= q && q < cells);
    unordered.insert(std::minmax(p, q));
    for (int flip = 0; flip < 4; ++flip) {
      const Pair& other = pair_table[flipped_pair(k, flip)];
      EXPECT_EQ(flipped_cell(p, flip), other.p) << "pair " << k << ", flip " << flip;
      EXPECT_EQ(flipped_cell(q, flip), other.q) << "pair " << k << ", flip " << flip;
    }
  }
  EXPECT_EQ(unordered.size(), static_cast<std::size_t>(pairs)) << "a pair occurs twice";
}

TEST(BscLayout, PermutationsKeepTheKindAndThePlaneOfABit) {
  const auto kind_of = [](int bit) {
    if (bit < depth_begin) return bit / cells;
    return planes + (bit - depth_begin) / pairs;
  };
  for (const FrameFlip& flip : frame_flips) {
    const auto permutation = make_permutation(flip);
    std::set<int> images(permutation.begin(), permutation.end());
    EXPECT_EQ(images.size(), static_cast<std::size_t>(bits));
    for (int bit = 0; bit < bits; ++bit) EXPECT_EQ(kind_of(permutation[bit]), kind_of(bit)) << "bit " << bit;
  }
}

TEST(BscLayout, PermutationsFormTheKleinGroup) {
  std::array<std::array<std::int16_t, bits>, 4> permutations;
  for (int flip = 0; flip < 4; ++flip) permutations[flip] = make_permutation(frame_flips[flip]);
  EXPECT_EQ(std::set(permutations.begin(), permutations.end()).size(), 4u);
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      // (-,-,+) after (+,-,-) is (-,+,-) and so on: numbers combine like bit masks, and every flip undoes itself.
      for (int bit = 0; bit < bits; ++bit) {
        ASSERT_EQ(permutations[a][permutations[b][bit]], permutations[a ^ b][bit]) << a << " after " << b;
      }
    }
  }
}

}  // namespace
}  // namespace igsp::bsc
