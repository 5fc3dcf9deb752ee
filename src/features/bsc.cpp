#include "features/bsc.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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
// A row of a patch: three weights and a zero. Generic vectors, which the compiler lowers to whatever width the machine
// has.
using WeightRow = float __attribute__((vector_size(16)));
struct WeightTable {
  WeightRow row[(steps + 1) * (steps + 1) * 3];
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
          table.row[(b * (steps + 1) + a) * 3 + dj + 1][di + 1] =
              squared <= 2.25 ? static_cast<float>(std::exp(-2.0 * squared)) : 0.0f;
        }
      }
    }
  }
  return table;
}
const WeightTable weights = make_weights();

// Sums per nearest cell for the patch around it, three rows each: a row's weights, then its weighted depths. One ring
// of cells outside the grid still reaches into it; what lies further out goes into a last cell that nobody reads, which
// is cheaper than a branch.
constexpr int ring_side = side + 2, ring_cells = ring_side * ring_side;
using SumRow = float __attribute__((vector_size(32)));
struct Patches {
  SumRow row[(ring_cells + 1) * 3];
};

constexpr int block = 64;  // points
// The first row of every point's patch and of its weights.
struct Places {
  int patch[block], weight[block];
};

// a, b: in-plane coordinates in cells (u).
inline __attribute__((always_inline)) Places places_of(const float* a, const float* b, int size) {
  Places places;
  for (int i = 0; i < size; ++i) {
    const float ca = std::nearbyint(a[i]), cb = std::nearbyint(b[i]);
    const bool near = std::abs(ca) <= half + 1 && std::abs(cb) <= half + 1;
    const int sa = static_cast<int>(std::nearbyint((a[i] - ca) * steps)) + steps / 2;
    const int sb = static_cast<int>(std::nearbyint((b[i] - cb) * steps)) + steps / 2;
    places.weight[i] = (sb * (steps + 1) + sa) * 3;
    places.patch[i] =
        (near ? (static_cast<int>(cb) + half + 1) * ring_side + static_cast<int>(ca) + half + 1 : ring_cells) * 3;
  }
  return places;
}

inline __attribute__((always_inline)) void add_point(const WeightRow* weight, float depth, SumRow* patch) {
  const SumRow factor{1, 1, 1, 1, depth, depth, depth, depth};
  for (int row = 0; row < 3; ++row) {
    patch[row] += __builtin_shufflevector(weight[row], weight[row], 0, 1, 2, 3, 0, 1, 2, 3) * factor;
  }
}

// Points in cells along the frame's axes. The three planes in one loop: each waits for its own last sum only.
IGSP_MULTIVERSION void accumulate(const float* a, const float* b, const float* c, std::size_t size,
                                  std::array<Patches, planes>& patches) {
  for (std::size_t begin = 0; begin < size; begin += block, a += block, b += block, c += block) {
    const int count = static_cast<int>(std::min<std::size_t>(block, size - begin));
    const Places xy = places_of(a, b, count), xz = places_of(a, c, count), yz = places_of(b, c, count);
    for (int i = 0; i < count; ++i) {
      add_point(weights.row + xy.weight[i], c[i], patches[0].row + xy.patch[i]);
      add_point(weights.row + xz.weight[i], b[i], patches[1].row + xz.patch[i]);
      add_point(weights.row + yz.weight[i], a[i], patches[2].row + yz.patch[i]);
    }
  }
}

// Sums in fixed point: integer addition has no order, so flips stay exact permutations. Truncation is symmetric.
constexpr float fixed_one = 1 << 11;
using FixedRow = std::int32_t __attribute__((vector_size(32)));
struct CellSums {
  std::array<std::int32_t, cells> weight;
  std::array<std::int32_t, cells> weighted_depth;
};

IGSP_MULTIVERSION void sum_patches(const Patches& patches, CellSums& sums) {
  for (int j = 0; j < side; ++j) {
    // What the patches of three rows of the ring add to row j, per column of the ring and column of the patch; ...
    FixedRow columns[ring_side] = {};
    for (int i = 0; i < ring_side; ++i) {
      for (int row = 0; row < 3; ++row) {
        const SumRow& sum = patches.row[((j + 2 - row) * ring_side + i) * 3 + row];
        columns[i] += __builtin_convertvector(sum * fixed_one, FixedRow);
      }
    }
    // ... then the three columns of the ring that reach a cell.
    for (int i = 0; i < side; ++i) {
      sums.weight[j * side + i] = columns[i][2] + columns[i + 1][1] + columns[i + 2][0];
      sums.weighted_depth[j * side + i] = columns[i][6] + columns[i + 1][5] + columns[i + 2][4];
    }
  }
}

void append_bits(Descriptor& descriptor, int first_bit, std::uint64_t bits_to_set) {
  descriptor[first_bit / 64] |= bits_to_set << (first_bit % 64);
  if (first_bit % 64 != 0 && first_bit / 64 + 1 < bsc_words) {
    descriptor[first_bit / 64 + 1] |= bits_to_set >> (64 - first_bit % 64);
  }
}

// Flag k as bit k: eight at once, by a product that moves byte i's bit to bit 56 + i.
template <std::size_t size>
std::uint64_t packed(const std::array<std::uint8_t, size>& flags) {
  static_assert(size % 8 == 0 && size <= 64);
  std::uint64_t result = 0;
  for (std::size_t first = 0; first < size; first += 8) {
    std::uint64_t eight = 0;
    for (std::size_t i = 0; i < 8; ++i) eight |= std::uint64_t{flags[first + i]} << 8 * i;
    result |= (eight * 0x0102040810204080u >> 56) << first;
  }
  return result;
}

// Unrolled, so that cells are addresses: vectors would have to gather them.
template <typename Visit>
inline __attribute__((always_inline)) void for_each_pair(const Visit& visit) {
  [&]<int... k>(std::integer_sequence<int, k...>) {
    (visit(k, pair_table[k]), ...);
  }
  (std::make_integer_sequence<int, pairs>());
}

// bit = |delta - mean| > sigma over the plane's pairs, without division: |n delta - sum| > sqrt(n sum2 - sum^2). Values
// stay below 2^20 (38.5 units of density, all weight in one cell), so that n delta - sum fits.
IGSP_MULTIVERSION std::uint64_t comparison_bits(const std::int32_t* value) {
  std::int32_t delta[pairs];
  for_each_pair([&](int k, Pair pair) { delta[k] = value[pair.p] - value[pair.q]; });
  std::int32_t sum = 0;
  std::int64_t sum2 = 0;
  for (int k = 0; k < pairs; ++k) {
    sum += delta[k];
    sum2 += std::int64_t{delta[k]} * delta[k];
  }
  const double scaled_sigma = std::sqrt(static_cast<double>(pairs * sum2 - std::int64_t{sum} * sum));
  const auto limit = static_cast<std::int32_t>(scaled_sigma);  // an integer exceeds sigma where it exceeds its floor
  std::array<std::uint8_t, pairs> far;
  for (int k = 0; k < pairs; ++k) far[k] = std::abs(pairs * delta[k] - sum) > limit;
  return packed(far);
}

IGSP_MULTIVERSION void describe_plane(const CellSums& sums, int plane, std::size_t support_size,
                                      Descriptor& descriptor) {
  // Normalised density rho = (W / u^2) / (n / (pi R^2)) with R = 3.5 u.
  const float rho_per_weight = static_cast<float>(M_PI * 0.25 * side * side / static_cast<double>(support_size));
  constexpr float steps_per_unit = 1 << 14;  // of rho and of the depth in u: fine enough, and sums of squares are exact
  std::int32_t density[cells], depth[cells];
  std::array<std::uint8_t, (cells + 7) / 8 * 8> occupied{};
  for (int cell = 0; cell < cells; ++cell) {
    const float weight = static_cast<float>(sums.weight[cell]);
    const float rho = weight / fixed_one * rho_per_weight;
    occupied[cell] = rho > 0.1f;
    density[cell] = static_cast<std::int32_t>(rho * steps_per_unit);
    depth[cell] = static_cast<std::int32_t>(static_cast<float>(sums.weighted_depth[cell]) / std::max(weight, 1.0f) *
                                            steps_per_unit);
  }
  std::array<std::uint8_t, pairs> some;
  for_each_pair([&](int k, Pair pair) { some[k] = (sums.weight[pair.p] | sums.weight[pair.q]) != 0; });
  append_bits(descriptor, plane * cells, packed(occupied));
  append_bits(descriptor, depth_begin + plane * pairs, comparison_bits(depth));
  append_bits(descriptor, density_begin + plane * pairs, comparison_bits(density) & packed(some));
}

// A support's coordinates along the axes of a frame, in cells.
struct Projected {
  std::vector<float> a, b, c;
};

IGSP_MULTIVERSION void project(const SupportView& support, const Eigen::Matrix3f& to_cells, Projected& projected) {
  const std::size_t size = support.size;
  projected.a.resize(size), projected.b.resize(size), projected.c.resize(size);
  const float *x = support.x, *y = support.y, *z = support.z;
  float *pa = projected.a.data(), *pb = projected.b.data(), *pc = projected.c.data();
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

// `projected`: memory that the next one may use again.
Descriptor describe(const SupportView& support, const Eigen::Matrix3d& frame, double descriptor_radius,
                    Projected& projected) {
  Descriptor descriptor{};
  if (support.size == 0) return descriptor;
  const double u = 2 * descriptor_radius / side;
  project(support, (frame.transpose() / u).cast<float>(), projected);
  std::array<Patches, planes> patches{};
  accumulate(projected.a.data(), projected.b.data(), projected.c.data(), support.size, patches);
  for (int plane = 0; plane < planes; ++plane) {
    CellSums sums;
    sum_patches(patches[plane], sums);
    describe_plane(sums, plane, support.size, descriptor);
  }
  return descriptor;
}

}  // namespace

Descriptor binary_shape_context(const SupportView& support, const Eigen::Matrix3d& frame, double descriptor_radius) {
  Projected projected;
  return describe(support, frame, descriptor_radius, projected);
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

void describe_in_frames(const SupportTable& supports, const EveryNth& chosen, std::span<const Eigen::Matrix3d> frames,
                        double descriptor_radius, int threads, std::span<std::vector<Descriptor>* const> descriptors) {
  for (std::vector<Descriptor>* of_frame : descriptors) of_frame->resize(supports.size());
  const std::size_t grain = std::max<std::size_t>(1, 32 / std::max<std::size_t>(1, frames.size()));
  parallel_blocks(supports.size(), threads, grain, [&](std::size_t begin, std::size_t end) {
    Projected projected;
    // All frames of a support while it is in the cache.
    for (std::size_t i = begin; i < end; ++i) {
      if (!chosen.has(i)) continue;
      for (std::size_t k = 0; k < frames.size(); ++k) {
        (*descriptors[k])[i] = describe(supports[i], frames[k], descriptor_radius, projected);
      }
    }
  });
}

}  // namespace igsp
