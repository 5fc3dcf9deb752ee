#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "matching/candidates.hpp"

namespace igsp {

/// Two candidates agree when one rigid motion can explain both: equal lengths between their points, the rotations of
/// their frames alike, and the difference of their points turned as those rotations turn it. The smooth term that the
/// paper names as future work.
struct ConsistencyOptions {
  double length_tolerance = 0;  ///< of | |a - a'| - |b - b'| | [units of the cloud]
  double min_length = 0;        ///< shorter pairs say nothing [units of the cloud]
  double max_angle_rad = 0;  ///< between the rotations of the two pairs of frames; three quarters: where they turn to
};

/// Symmetric relation over candidates, one bitset a row.
class ConsistencyGraph {
 public:
  ConsistencyGraph(std::size_t size) : size_(size), words_((size + 63) / 64), bits_(size * words_, 0) {}

  std::size_t size() const { return size_; }
  bool agree(std::size_t a, std::size_t b) const { return row(a)[b / 64] >> (b % 64) & 1; }
  std::span<const std::uint64_t> row(std::size_t a) const { return {&bits_[a * words_], words_}; }
  std::span<std::uint64_t> row(std::size_t a) { return {&bits_[a * words_], words_}; }

  int degree(std::size_t a) const {
    int count = 0;
    for (const std::uint64_t word : row(a)) count += std::popcount(word);
    return count;
  }
  int common_neighbours(std::size_t a, std::size_t b) const;
  template <typename Visit>
  void visit_neighbours(std::size_t a, const Visit& visit) const {
    const auto words = row(a);
    for (std::size_t w = 0; w < words_; ++w) {
      for (std::uint64_t word = words[w]; word != 0; word &= word - 1) visit(64 * w + std::countr_zero(word));
    }
  }

 private:
  std::size_t size_, words_;
  std::vector<std::uint64_t> bits_;
};

ConsistencyGraph consistency_graph(std::span<const Candidate> candidates, PointView source, PointView target,
                                   const ConsistencyOptions& options, int threads);

}  // namespace igsp
