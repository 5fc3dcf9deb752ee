#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "igsp/features.hpp"

namespace igsp {

/// The same kernel compiled for several instruction sets in one binary; all give the same numbers.
enum class SimdLevel { baseline, avx2, avx512, avx512_bitalg };
std::string_view to_string(SimdLevel level);

/// What this processor can run, `baseline` first, the fastest last. Only `baseline` where the compiler or the processor
/// is not x86-64, and in a build with IGSP_PLAIN_KERNELS.
std::vector<SimdLevel> available_simd_levels();
SimdLevel best_simd_level();

/// Descriptors as a kernel wants them: blocks of 32, and in a block 16-bit piece by 16-bit piece, so that neighbouring
/// lanes of a vector hold the same piece of neighbouring descriptors.
class TargetBlocks {
 public:
  static constexpr std::size_t lanes = 32;
  static constexpr std::size_t pieces = bsc_words * 4;
  struct alignas(64) Block {
    std::uint16_t piece[pieces][lanes];
  };

  explicit TargetBlocks(std::span<const Descriptor> targets);

  std::size_t size() const { return size_; }
  std::size_t padded_size() const { return blocks_.size() * lanes; }
  std::span<const Block> blocks() const { return blocks_; }

 private:
  std::size_t size_;
  std::vector<Block> blocks_;  // the last one is filled up with zero descriptors
};

/// distances[j] = least Hamming distance between any of the variants and target j. `distances` has padded_size().
/// `level` must be among available_simd_levels().
void least_distances(std::span<const Descriptor> variants, const TargetBlocks& targets, SimdLevel level,
                     std::span<std::uint16_t> distances);

/// The same for one target, but no more than `bound`.
std::uint16_t least_distance(std::span<const Descriptor> variants, const Descriptor& target, std::uint16_t bound);

}  // namespace igsp
