#include "features/bsc.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/multiversion.hpp"
#include "core/parallel.hpp"
#include "features/bsc_layout.hpp"

namespace igsp {
namespace {

using namespace bsc;

static_assert(bits == bsc_bits && bits <= 64 * bsc_words);

// A point touches the cells whose centre is within 1.5 u: the 3 x 3 patch around its nearest cell. Weights are
// tabulated over the position inside the nearest cell, in 1/16 u. Steps are centred on 0 and rounding is symmetric, so
// a flipped point finds exactly the flipped weights.
constexpr int steps = 16;
// 9 weights padded to 16: a generic vector, which the compiler lowers to whatever width the machine has.
using Patch = float __attribute__((vector_size(64)));
struct WeightTable {
  Patch weight[(steps + 1) * (steps + 1)];
};

WeightTable make_weights() {
  WeightTable table{};
  for (int b = 0; b <= steps; ++b) {
    for (int a = 0; a <= steps; ++a) {
      const double x = static_cast<double>(a) / steps - 0.5, y = static_cast<double>(b) / steps - 0.5;
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          const double squared = (di - x) * (di - x) + (dj - y) * (dj - y);
          // g = exp(-r^2 / (2 (u/2)^2)), lengths in u
          table.weight[b * (steps + 1) + a][(dj + 1) * 3 + di + 1] =
              squared <= 2.25 ? static_cast<float>(std::exp(-2.0 * squared)) : 0.0f;
        }
      }
    }
  }
  return table;
}
const WeightTable weights = make_weights();

// Sums per nearest cell: 9 weights and 9 weighted depths for the patch around it. One ring of cells outside the grid
// still reaches into it.
constexpr int ring_side = side + 2;
struct alignas(64) Patches {
  Patch density[ring_side * ring_side];
  Patch depth[ring_side * ring_side];
};

// a, b: in-plane coordinates, c: depth, all in cells (u).
IGSP_MULTIVERSION void accumulate(const float* a, const float* b, const float* c, std::size_t size, Patches& patches) {
  constexpr int block = 64;
  int cell[block], step[block];
  for (std::size_t begin = 0; begin < size; begin += block) {
    const int count = static_cast<int>(std::min<std::size_t>(block, size - begin));
    for (int i = 0; i < count; ++i) {
      const float ca = std::nearbyint(a[begin + i]), cb = std::nearbyint(b[begin + i]);
      const bool near = std::abs(ca) <= half + 1 && std::abs(cb) <= half + 1;
      const int sa = static_cast<int>(std::nearbyint((a[begin + i] - ca) * steps)) + steps / 2;
      const int sb = static_cast<int>(std::nearbyint((b[begin + i] - cb) * steps)) + steps / 2;
      step[i] = sb * (steps + 1) + sa;
      cell[i] = near ? (static_cast<int>(cb) + half + 1) * ring_side + static_cast<int>(ca) + half + 1 : -1;
    }
    for (int i = 0; i < count; ++i) {
      if (cell[i] < 0) continue;
      const Patch& weight = weights.weight[step[i]];
      patches.density[cell[i]] += weight;
      patches.depth[cell[i]] += c[begin + i] * weight;
    }
  }
}

// Sums in fixed point: integer addition has no order, so flips stay exact permutations. Truncation is symmetric.
constexpr float fixed_one = 1 << 11;
using FixedPatch = std::int32_t __attribute__((vector_size(64)));
struct CellSums {
  std::array<std::int32_t, cells> weight{};
  std::array<std::int32_t, cells> weighted_depth{};
};

IGSP_MULTIVERSION void sum_patches(const Patches& patches, CellSums& sums) {
  // A margin of one ring takes what falls outside the grid.
  constexpr int margin_side = ring_side + 2;
  std::int32_t weight[margin_side * margin_side] = {}, depth[margin_side * margin_side] = {};
  for (int j = 0; j < ring_side; ++j) {
    for (int i = 0; i < ring_side; ++i) {
      const int nearest = j * ring_side + i;
      if (patches.density[nearest][4] == 0) continue;  // no point: the weight at the nearest cell is never 0
      const FixedPatch w = __builtin_convertvector(patches.density[nearest] * fixed_one, FixedPatch);
      const FixedPatch d = __builtin_convertvector(patches.depth[nearest] * fixed_one, FixedPatch);
      for (int k = 0; k < 9; ++k) {
        weight[(j + k / 3) * margin_side + i + k % 3] += w[k];
        depth[(j + k / 3) * margin_side + i + k % 3] += d[k];
      }
    }
  }
  for (int cell = 0; cell < cells; ++cell) {
    const int margin_cell = (cell / side + 2) * margin_side + cell % side + 2;
    sums.weight[cell] = weight[margin_cell];
    sums.weighted_depth[cell] = depth[margin_cell];
  }
}

void append_bits(Descriptor& descriptor, int first_bit, std::uint64_t bits_to_set) {
  descriptor[first_bit / 64] |= bits_to_set << (first_bit % 64);
  if (first_bit % 64 != 0 && first_bit / 64 + 1 < bsc_words) {
    descriptor[first_bit / 64 + 1] |= bits_to_set >> (64 - first_bit % 64);
  }
}

// bit = |delta - mean| > sigma over the plane's pairs, without division: |n delta - sum| > sqrt(n sum2 - sum^2).
std::uint64_t comparison_bits(const std::array<std::int32_t, cells>& value) {
  std::array<std::int32_t, pairs> delta;
  std::int64_t sum = 0, sum2 = 0;
  for (int k = 0; k < pairs; ++k) {
    delta[k] = value[pair_table[k].p] - value[pair_table[k].q];
    sum += delta[k];
    sum2 += std::int64_t{delta[k]} * delta[k];
  }
  const double scaled_sigma = std::sqrt(static_cast<double>(pairs * sum2 - sum * sum));
  std::uint64_t result = 0;
  for (int k = 0; k < pairs; ++k) {
    const auto deviation = static_cast<double>(std::abs(pairs * std::int64_t{delta[k]} - sum));
    result |= std::uint64_t{deviation > scaled_sigma} << k;
  }
  return result;
}

void describe_plane(const CellSums& sums, int plane, std::size_t support_size, Descriptor& descriptor) {
  // Normalised density rho = (W / u^2) / (n / (pi R^2)) with R = 3.5 u.
  const float rho_per_weight = static_cast<float>(M_PI * 0.25 * side * side / static_cast<double>(support_size));
  constexpr float steps_per_unit = 1 << 14;  // of rho and of the depth in u: fine enough, and sums of squares are exact
  std::array<std::int32_t, cells> density, depth;
  std::uint64_t occupied = 0, empty_pairs = 0;
  for (int cell = 0; cell < cells; ++cell) {
    const float weight = static_cast<float>(sums.weight[cell]);
    const float rho = weight / fixed_one * rho_per_weight;
    occupied |= std::uint64_t{rho > 0.1f} << cell;
    density[cell] = static_cast<std::int32_t>(rho * steps_per_unit);
    depth[cell] = static_cast<std::int32_t>(static_cast<float>(sums.weighted_depth[cell]) / std::max(weight, 1.0f) *
                                            steps_per_unit);
  }
  for (int k = 0; k < pairs; ++k) {
    const bool empty = sums.weight[pair_table[k].p] == 0 && sums.weight[pair_table[k].q] == 0;
    empty_pairs |= std::uint64_t{empty} << k;
  }
  append_bits(descriptor, plane * cells, occupied);
  append_bits(descriptor, depth_begin + plane * pairs, comparison_bits(depth));
  append_bits(descriptor, density_begin + plane * pairs, comparison_bits(density) & ~empty_pairs);
}

IGSP_MULTIVERSION void project(const SupportView& support, const Eigen::Matrix3f& to_cells, std::vector<float>& a,
                               std::vector<float>& b, std::vector<float>& c) {
  const std::size_t size = support.size;
  a.resize(size), b.resize(size), c.resize(size);
  const float *x = support.x, *y = support.y, *z = support.z;
  float *pa = a.data(), *pb = b.data(), *pc = c.data();
  const float m00 = to_cells(0, 0), m01 = to_cells(0, 1), m02 = to_cells(0, 2);
  const float m10 = to_cells(1, 0), m11 = to_cells(1, 1), m12 = to_cells(1, 2);
  const float m20 = to_cells(2, 0), m21 = to_cells(2, 1), m22 = to_cells(2, 2);
#pragma omp simd
  for (std::size_t i = 0; i < size; ++i) {
    pa[i] = m00 * x[i] + m01 * y[i] + m02 * z[i];
    pb[i] = m10 * x[i] + m11 * y[i] + m12 * z[i];
    pc[i] = m20 * x[i] + m21 * y[i] + m22 * z[i];
  }
}

}  // namespace

Descriptor binary_shape_context(const SupportView& support, const Eigen::Matrix3d& frame, double descriptor_radius) {
  Descriptor descriptor{};
  if (support.size == 0) return descriptor;
  const double u = 2 * descriptor_radius / side;
  std::vector<float> a, b, c;
  project(support, (frame.transpose() / u).cast<float>(), a, b, c);
  const std::array<std::array<const float*, 3>, planes> axes{
      {{a.data(), b.data(), c.data()}, {a.data(), c.data(), b.data()}, {b.data(), c.data(), a.data()}}};
  for (int plane = 0; plane < planes; ++plane) {
    Patches patches{};
    CellSums sums;
    accumulate(axes[plane][0], axes[plane][1], axes[plane][2], support.size, patches);
    sum_patches(patches, sums);
    describe_plane(sums, plane, support.size, descriptor);
  }
  return descriptor;
}

Descriptor flipped(const Descriptor& descriptor, int frame_flip) {
  static constexpr std::array<std::array<std::int16_t, bits>, 4> permutations{
      make_permutation(frame_flips[0]), make_permutation(frame_flips[1]), make_permutation(frame_flips[2]),
      make_permutation(frame_flips[3])};
  Descriptor result{};
  for (int bit = 0; bit < bits; ++bit) {
    const int from = permutations[frame_flip][bit];
    result[bit / 64] |= (descriptor[from / 64] >> (from % 64) & 1) << (bit % 64);
  }
  return result;
}

std::vector<Descriptor> sign_variants(std::span<const Descriptor> descriptors, int variants) {
  std::vector<Descriptor> result;
  result.reserve(descriptors.size() * variants);
  for (const Descriptor& descriptor : descriptors) {
    for (int variant = 0; variant < variants; ++variant) result.push_back(flipped(descriptor, variant));
  }
  return result;
}

std::vector<Descriptor> describe_in_frame(const SupportTable& supports, const Eigen::Matrix3d& frame,
                                          double descriptor_radius, int threads) {
  std::vector<Descriptor> descriptors(supports.size());
  parallel_blocks(supports.size(), threads, 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      descriptors[i] = binary_shape_context(supports[i], frame, descriptor_radius);
    }
  });
  return descriptors;
}

}  // namespace igsp
