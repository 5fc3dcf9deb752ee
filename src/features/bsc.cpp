#include "features/bsc.hpp"

#include <array>
#include <cmath>

#include "core/multiversion.hpp"
#include "core/parallel.hpp"
#include "features/bsc_layout.hpp"

namespace igsp {
namespace {

using namespace bsc;

static_assert(bits == bsc_bits && bits <= 64 * bsc_words);

// A point touches the cells whose centre is within 1.5 u: the 3 x 3 patch around its nearest cell. Weights are tabulated
// over the position inside the nearest cell, in 1/16 u. Steps are centred on 0 and rounding is symmetric, so a flipped
// point finds exactly the flipped weights.
constexpr int steps = 16;
constexpr int patch = 16;  // 9 weights, padded to full vectors
struct WeightTable {
  alignas(64) float weight[(steps + 1) * (steps + 1)][patch];
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
  float density[ring_side * ring_side][patch];
  float depth[ring_side * ring_side][patch];
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
      const float* __restrict w = weights.weight[step[i]];
      float* __restrict density = patches.density[cell[i]];
      float* __restrict depth = patches.depth[cell[i]];
      const float d = c[begin + i];
      for (int k = 0; k < patch; ++k) {
        density[k] += w[k];
        depth[k] += d * w[k];
      }
    }
  }
}

// Sums in fixed point: integer addition has no order, so flips stay exact permutations.
constexpr double fixed_one = 1 << 20;
struct CellSums {
  std::array<std::int64_t, cells> weight{};
  std::array<std::int64_t, cells> weighted_depth{};
};

CellSums sum_patches(const Patches& patches) {
  CellSums sums;
  for (int j = -half - 1; j <= half + 1; ++j) {
    for (int i = -half - 1; i <= half + 1; ++i) {
      const int nearest = (j + half + 1) * ring_side + i + half + 1;
      if (patches.density[nearest][4] == 0) continue;  // no point: the weight at the nearest cell is never 0
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          if (std::abs(i + di) > half || std::abs(j + dj) > half) continue;
          const int cell = cell_number(i + di, j + dj), k = (dj + 1) * 3 + di + 1;
          sums.weight[cell] += std::llround(patches.density[nearest][k] * fixed_one);
          sums.weighted_depth[cell] += std::llround(patches.depth[nearest][k] * fixed_one);
        }
      }
    }
  }
  return sums;
}

void set_bit(Descriptor& descriptor, int bit) { descriptor[bit / 64] |= std::uint64_t{1} << (bit % 64); }

// bit = |delta - mean| > sigma over the plane's pairs, without division: |n delta - sum| > sqrt(n sum2 - sum^2).
template <typename Suppressed>
void set_comparison_bits(const std::array<std::int64_t, cells>& value, int first_bit, const Suppressed& suppressed,
                         Descriptor& descriptor) {
  std::array<std::int64_t, pairs> delta;
  std::int64_t sum = 0, sum2 = 0;
  for (int k = 0; k < pairs; ++k) {
    delta[k] = value[pair_table[k].p] - value[pair_table[k].q];
    sum += delta[k];
    sum2 += delta[k] * delta[k];
  }
  const double scaled_sigma = std::sqrt(static_cast<double>(pairs * sum2 - sum * sum));
  for (int k = 0; k < pairs; ++k) {
    const bool stands_out = static_cast<double>(std::abs(pairs * delta[k] - sum)) > scaled_sigma;
    if (stands_out && !suppressed(k)) set_bit(descriptor, first_bit + k);
  }
}

void describe_plane(const CellSums& sums, int plane, std::size_t support_size, Descriptor& descriptor) {
  // Normalised density rho = (W / u^2) / (n / (pi R^2)) with R = 3.5 u.
  const double rho_per_weight = M_PI * 0.25 * side * side / static_cast<double>(support_size);
  constexpr double steps_per_unit = 1 << 16;  // of rho and of the depth in u: fine enough, and squares fit 64 bits
  std::array<std::int64_t, cells> density, depth;
  for (int cell = 0; cell < cells; ++cell) {
    const double weight = static_cast<double>(sums.weight[cell]);
    const double rho = weight / fixed_one * rho_per_weight;
    if (rho > 0.1) set_bit(descriptor, plane * cells + cell);
    density[cell] = std::llround(rho * steps_per_unit);
    depth[cell] =
        weight > 0 ? std::llround(static_cast<double>(sums.weighted_depth[cell]) / weight * steps_per_unit) : 0;
  }
  set_comparison_bits(depth, depth_begin + plane * pairs, [](int) { return false; }, descriptor);
  set_comparison_bits(
      density, density_begin + plane * pairs,
      [&](int k) { return sums.weight[pair_table[k].p] == 0 && sums.weight[pair_table[k].q] == 0; }, descriptor);
}

IGSP_MULTIVERSION void project(const Support& support, const Eigen::Matrix3f& to_cells, std::vector<float>& a,
                               std::vector<float>& b, std::vector<float>& c) {
  const std::size_t size = support.size();
  a.resize(size), b.resize(size), c.resize(size);
  const float *x = support.x.data(), *y = support.y.data(), *z = support.z.data();
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

Descriptor binary_shape_context(const Support& support, const Eigen::Matrix3d& frame, double descriptor_radius) {
  Descriptor descriptor{};
  if (support.size() == 0) return descriptor;
  const double u = 2 * descriptor_radius / side;
  std::vector<float> a, b, c;
  project(support, (frame.transpose() / u).cast<float>(), a, b, c);
  const std::array<std::array<const float*, 3>, planes> axes{
      {{a.data(), b.data(), c.data()}, {a.data(), c.data(), b.data()}, {b.data(), c.data(), a.data()}}};
  for (int plane = 0; plane < planes; ++plane) {
    Patches patches{};
    accumulate(axes[plane][0], axes[plane][1], axes[plane][2], support.size(), patches);
    describe_plane(sum_patches(patches), plane, support.size(), descriptor);
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

std::vector<Descriptor> describe_in_frame(const PointGrid& grid, PointView places, const Eigen::Matrix3d& frame,
                                          double descriptor_radius, int threads) {
  std::vector<Descriptor> descriptors(places.size());
  parallel_blocks(places.size(), threads, 32, [&](std::size_t begin, std::size_t end) {
    Support support;
    for (std::size_t i = begin; i < end; ++i) {
      gather_support(grid, places[i], descriptor_radius, support);
      descriptors[i] = binary_shape_context(support, frame, descriptor_radius);
    }
  });
  return descriptors;
}

}  // namespace igsp
