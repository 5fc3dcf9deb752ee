#include "matching/hamming_kernel.hpp"

#include <algorithm>
#include <array>
#include <bit>

// Plain loops that the compiler vectorises, compiled once per instruction set and chosen by a branch at run time: no
// IFUNC, so sanitizers can run every level. IGSP_PLAIN_KERNELS leaves the baseline alone.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(IGSP_PLAIN_KERNELS)
#define IGSP_X86_KERNELS 1
#endif
#if defined(__GNUC__)
#define IGSP_INLINE inline __attribute__((always_inline))
#define IGSP_RESTRICT __restrict__
#define IGSP_UNROLL _Pragma("GCC unroll 28")
#else
#define IGSP_INLINE inline
#define IGSP_RESTRICT
#define IGSP_UNROLL
#endif

namespace igsp {
namespace {

using Piece = std::uint16_t;
using Block = TargetBlocks::Block;
using Pieces = std::array<Piece, TargetBlocks::pieces>;

Pieces pieces_of(const Descriptor& descriptor) {
  Pieces pieces;
  for (std::size_t p = 0; p < pieces.size(); ++p) pieces[p] = static_cast<Piece>(descriptor[p / 4] >> (16 * (p % 4)));
  return pieces;
}

/// sum += a + b in every bit position; returns the carries.
IGSP_INLINE Piece add_bits(Piece& sum, Piece a, Piece b) {
  const Piece either = a ^ b;
  const Piece carry = (a & b) | (either & sum);
  sum ^= either;
  return carry;
}

/// Bits set in each group of four.
IGSP_INLINE Piece count_in_nibbles(Piece x) {
  x = x - ((x >> 1) & 0x5555);
  return (x & 0x3333) + ((x >> 2) & 0x3333);
}

/// Sums of neighbouring groups of four.
IGSP_INLINE Piece nibbles_to_bytes(Piece x) {
  return (x & 0x0f0f) + ((x >> 4) & 0x0f0f);
}

/// Bits set in all 28 pieces, without a popcount instruction: carry-save adders reduce them to five words of weight 1,
/// 2, 4, 8, 16. The order keeps few values alive at a time.
struct CountByAdders {
  static IGSP_INLINE Piece count(const Piece (&d)[TargetBlocks::pieces]) {
    Piece ones = d[0];
    Piece twos = add_bits(ones, d[1], d[2]);
    Piece carry_a = add_bits(ones, d[3], d[4]);
    Piece carry_b = add_bits(ones, d[5], d[6]);
    Piece fours = add_bits(twos, carry_a, carry_b);
    Piece eights = add_eight(ones, twos, fours, d[7], d[8], d[9], d[10], d[11], d[12], d[13], d[14]);
    const Piece more_eights = add_eight(ones, twos, fours, d[15], d[16], d[17], d[18], d[19], d[20], d[21], d[22]);
    const Piece last_eights = add_eight(ones, twos, fours, d[23], d[24], d[25], d[26], d[27], 0, 0, 0);
    const Piece sixteens = add_bits(eights, more_eights, last_eights);

    const Piece low = count_in_nibbles(ones) + (count_in_nibbles(twos) << 1);
    const Piece high = count_in_nibbles(fours) + (count_in_nibbles(eights) << 1);
    const Piece bytes =
        nibbles_to_bytes(low) + (nibbles_to_bytes(high) << 2) + (nibbles_to_bytes(count_in_nibbles(sixteens)) << 4);
    return (bytes & 0x00ff) + (bytes >> 8);
  }

  /// Adds eight pieces; returns what carries into the eights.
  static IGSP_INLINE Piece add_eight(Piece& ones, Piece& twos, Piece& fours, Piece a, Piece b, Piece c, Piece d,
                                     Piece e, Piece f, Piece g, Piece h) {
    const Piece twos_a = add_bits(ones, a, b);
    const Piece twos_b = add_bits(ones, c, d);
    const Piece fours_a = add_bits(twos, twos_a, twos_b);
    const Piece twos_c = add_bits(ones, e, f);
    const Piece twos_d = add_bits(ones, g, h);
    const Piece fours_b = add_bits(twos, twos_c, twos_d);
    return add_bits(fours, fours_a, fours_b);
  }
};

struct CountByInstruction {
  static IGSP_INLINE Piece count(const Piece (&d)[TargetBlocks::pieces]) {
    Piece sum = 0;
    IGSP_UNROLL
    for (std::size_t p = 0; p < TargetBlocks::pieces; ++p) sum += static_cast<Piece>(std::popcount(d[p]));
    return sum;
  }
};

struct Row {
  std::span<const Pieces> variants;
  std::span<const Block> blocks;
  Piece* distances;
};

template <typename Count>
IGSP_INLINE void compute_row(const Row& row) {
  constexpr std::size_t lanes = TargetBlocks::lanes;
  Piece* IGSP_RESTRICT distances = row.distances;
  for (const Block& block : row.blocks) {
    std::fill(distances, distances + lanes, Piece{0xffff});
    for (const Pieces& variant : row.variants) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        Piece difference[TargetBlocks::pieces];
        IGSP_UNROLL
        for (std::size_t p = 0; p < TargetBlocks::pieces; ++p) {
          difference[p] = static_cast<Piece>(block.piece[p][lane] ^ variant[p]);
        }
        const Piece distance = Count::count(difference);
        distances[lane] = distance < distances[lane] ? distance : distances[lane];
      }
    }
    distances += lanes;
  }
}

IGSP_INLINE std::uint16_t least_of(std::span<const Descriptor> variants, const Descriptor& target,
                                   std::uint16_t bound) {
  int least = bound;
  for (const Descriptor& variant : variants) {
    int distance = 0;
    for (int w = 0; w < 4; ++w) distance += std::popcount(variant[w] ^ target[w]);
    if (distance >= least) continue;
    for (int w = 4; w < bsc_words; ++w) distance += std::popcount(variant[w] ^ target[w]);
    least = std::min(least, distance);
  }
  return static_cast<std::uint16_t>(least);
}

void row_baseline(const Row& row) {
  compute_row<CountByAdders>(row);
}

#ifdef IGSP_X86_KERNELS
// Clang has no such attribute.
#ifdef __clang__
#define IGSP_WHOLE_VECTORS
#else
#define IGSP_WHOLE_VECTORS ",prefer-vector-width=512"
#endif

__attribute__((target("avx2"))) void row_avx2(const Row& row) {
  compute_row<CountByAdders>(row);
}

__attribute__((target("avx512f,avx512bw,avx512vl" IGSP_WHOLE_VECTORS))) void row_avx512(const Row& row) {
  compute_row<CountByAdders>(row);
}

__attribute__((target("avx512f,avx512bw,avx512vl,avx512bitalg,popcnt" IGSP_WHOLE_VECTORS))) void row_avx512_bitalg(
    const Row& row) {
  compute_row<CountByInstruction>(row);
}

__attribute__((target("popcnt"))) std::uint16_t least_with_popcnt(std::span<const Descriptor> variants,
                                                                  const Descriptor& target, std::uint16_t bound) {
  return least_of(variants, target, bound);
}

bool runs(SimdLevel level) {
  const bool avx512 =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  switch (level) {
    case SimdLevel::baseline:
      return true;
    case SimdLevel::avx2:
      return __builtin_cpu_supports("avx2");
    case SimdLevel::avx512:
      return avx512;
    case SimdLevel::avx512_bitalg:
      return avx512 && __builtin_cpu_supports("avx512bitalg") && __builtin_cpu_supports("popcnt");
  }
  return false;
}
#else
bool runs(SimdLevel level) {
  return level == SimdLevel::baseline;
}
#endif

}  // namespace

std::string_view to_string(SimdLevel level) {
  switch (level) {
    case SimdLevel::baseline:
      return "baseline";
    case SimdLevel::avx2:
      return "avx2";
    case SimdLevel::avx512:
      return "avx512";
    case SimdLevel::avx512_bitalg:
      return "avx512_bitalg";
  }
  return "unknown";
}

std::vector<SimdLevel> available_simd_levels() {
  std::vector<SimdLevel> levels;
  for (const SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512, SimdLevel::avx512_bitalg}) {
    if (runs(level)) levels.push_back(level);
  }
  return levels;
}

SimdLevel best_simd_level() {
  return available_simd_levels().back();
}

TargetBlocks::TargetBlocks(std::span<const Descriptor> targets)
    : size_(targets.size()), blocks_((targets.size() + lanes - 1) / lanes) {
  for (std::size_t j = 0; j < targets.size(); ++j) {
    const Pieces piece = pieces_of(targets[j]);
    for (std::size_t p = 0; p < pieces; ++p) blocks_[j / lanes].piece[p][j % lanes] = piece[p];
  }
}

void least_distances(std::span<const Descriptor> variants, const TargetBlocks& targets, SimdLevel level,
                     std::span<std::uint16_t> distances) {
  std::vector<Pieces> pieces(variants.size());
  std::transform(variants.begin(), variants.end(), pieces.begin(), pieces_of);
  const Row row{pieces, targets.blocks(), distances.data()};
#ifdef IGSP_X86_KERNELS
  if (level == SimdLevel::avx512_bitalg) return row_avx512_bitalg(row);
  if (level == SimdLevel::avx512) return row_avx512(row);
  if (level == SimdLevel::avx2) return row_avx2(row);
#else
  (void)level;
#endif
  row_baseline(row);
}

std::uint16_t least_distance(std::span<const Descriptor> variants, const Descriptor& target, std::uint16_t bound) {
#ifdef IGSP_X86_KERNELS
  if (__builtin_cpu_supports("popcnt")) return least_with_popcnt(variants, target, bound);
#endif
  return least_of(variants, target, bound);
}

}  // namespace igsp
