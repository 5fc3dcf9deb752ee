#pragma once

#include <array>
#include <cstdint>

// The geometry of a Binary Shape Context: cells, pairs, flips and the position of every bit. All of it is constexpr, so
// that no table has to be shipped beside the program.
namespace igsp::bsc {

inline constexpr int side = 7;             // N: cells a side
inline constexpr int half = side / 2;      // cells run from -half to +half, the keypoint lies in cell 0
inline constexpr int cells = side * side;  // N^2
inline constexpr int planes = 3;           // XY (depth z), XZ (depth y), YZ (depth x)
inline constexpr int orbits = 12;
inline constexpr int pairs = 4 * orbits;  // compared cell pairs per plane
inline constexpr int depth_begin = planes * cells;
inline constexpr int density_begin = depth_begin + planes * pairs;
inline constexpr int bits = density_begin + planes * pairs;

enum Flip : int { none = 0, flip_i = 1, flip_j = 2, flip_both = 3 };

constexpr int cell_number(int i, int j) {
  return (j + half) * side + (i + half);
}
constexpr int flipped_cell(int cell, int flip) {
  const int i = cell % side - half, j = cell / side - half;
  return cell_number(flip & flip_i ? -i : i, flip & flip_j ? -j : j);
}

struct Pair {
  int p, q;
};

// One representative per orbit under the flips, as (i, j) of p and q: short and long, radial and tangential, none fixed
// by a flip, no orbit twice. Each cell ring takes part.
inline constexpr std::array<std::array<int, 4>, orbits> representatives{{{0, 1, 2, 2},
                                                                         {1, 0, 3, 1},
                                                                         {1, 1, -2, 3},
                                                                         {1, 2, -1, 0},
                                                                         {2, 1, -3, -2},
                                                                         {3, 0, 1, -3},
                                                                         {2, 0, -1, -1},
                                                                         {0, 2, 3, 3},
                                                                         {3, 2, 1, 3},
                                                                         {0, 3, -2, 1},
                                                                         {1, 3, 2, -1},
                                                                         {3, -1, 0, 0}}};

constexpr std::array<Pair, pairs> make_pairs() {
  std::array<Pair, pairs> table{};
  for (int orbit = 0; orbit < orbits; ++orbit) {
    const auto& r = representatives[orbit];
    for (int flip = 0; flip < 4; ++flip) {
      table[4 * orbit + flip] = {flipped_cell(cell_number(r[0], r[1]), flip),
                                 flipped_cell(cell_number(r[2], r[3]), flip)};
    }
  }
  return table;
}
inline constexpr std::array<Pair, pairs> pair_table = make_pairs();

/// Pair k of a plane seen after a flip is pair flipped_pair(k, flip): within an orbit, flips combine like bit masks.
constexpr int flipped_pair(int pair, int flip) {
  return (pair & ~3) | ((pair & 3) ^ flip);
}

constexpr bool pairs_are_distinct() {
  for (int a = 0; a < pairs; ++a) {
    for (int b = 0; b < a; ++b) {
      const Pair &x = pair_table[a], &y = pair_table[b];
      if ((x.p == y.p && x.q == y.q) || (x.p == y.q && x.q == y.p)) return false;
    }
  }
  return true;
}
static_assert(pairs_are_distinct());

/// The proper sign changes of a frame (x, y, n) -> (s_x x, s_y y, s_n n), and what each does to the cells of the three
/// planes. Depth signs need no entry: depth bits compare magnitudes of signed depths about their mean.
struct FrameFlip {
  std::array<int, 3> signs;
  std::array<int, planes> plane_flips;
};
inline constexpr std::array<FrameFlip, 4> frame_flips{{
    {{+1, +1, +1}, {none, none, none}},
    {{-1, -1, +1}, {flip_both, flip_i, flip_i}},
    {{+1, -1, -1}, {flip_j, flip_j, flip_both}},
    {{-1, +1, -1}, {flip_i, flip_both, flip_j}},
}};

/// bit b of the flipped descriptor is bit permutation[b] of the original.
constexpr std::array<std::int16_t, bits> make_permutation(const FrameFlip& frame_flip) {
  std::array<std::int16_t, bits> permutation{};
  for (int plane = 0; plane < planes; ++plane) {
    const int flip = frame_flip.plane_flips[plane];
    for (int cell = 0; cell < cells; ++cell) {
      permutation[plane * cells + cell] = static_cast<std::int16_t>(plane * cells + flipped_cell(cell, flip));
    }
    for (int k = 0; k < pairs; ++k) {
      const int source = plane * pairs + flipped_pair(k, flip), bit = plane * pairs + k;
      permutation[depth_begin + bit] = static_cast<std::int16_t>(depth_begin + source);
      permutation[density_begin + bit] = static_cast<std::int16_t>(density_begin + source);
    }
  }
  return permutation;
}

}  // namespace igsp::bsc
