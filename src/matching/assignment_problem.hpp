#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "matching/assignment.hpp"

namespace igsp {

/// Throws InvalidArgument that names what `solve_assignment` cannot take.
void check_assignment_problem(std::size_t sources, std::size_t targets, std::span<const AssignmentEdge> edges,
                              std::int64_t threshold);

/// The same edges with the sides exchanged, sorted again.
std::vector<AssignmentEdge> transposed(std::size_t targets, std::span<const AssignmentEdge> edges);

/// A row for every source, its entries by rising cost (then column): a search looks at the first few only.
class AssignmentRows {
 public:
  struct Entry {
    std::int64_t cost;
    std::int32_t column;
  };

  /// Edges sorted by (source, target).
  AssignmentRows(std::size_t sources, std::span<const AssignmentEdge> edges);

  std::size_t size() const { return first_.size() - 1; }
  std::span<const Entry> operator[](std::int32_t row) const {
    return {entries_.data() + first_[row], entries_.data() + first_[row + 1]};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<Entry> entries_;
};

}  // namespace igsp
