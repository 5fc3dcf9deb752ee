#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace igsp {

/// Fixed-point units per bit: costs are integers, so that optimality can be proved with `==`.
inline constexpr std::int64_t assignment_units_per_bit = std::int64_t{1} << 20;

/// Rounds to the nearest unit. Compare costs with the threshold after this, not before: `cost < threshold` must hold
/// between the integers.
inline std::int64_t to_assignment_units(double bits) {
  constexpr double most = 0x1p62;  // more bits than any threshold is allowed
  return std::llround(std::min(bits * static_cast<double>(assignment_units_per_bit), most));
}
inline double bits_from_assignment_units(std::int64_t units) {
  return static_cast<double>(units) / static_cast<double>(assignment_units_per_bit);
}

/// A pair that may be matched: CD < T_cd.
struct AssignmentEdge {
  std::uint32_t source;
  std::uint32_t target;
  std::int64_t cost;
};

struct Assignment {
  std::vector<std::int32_t> target_of_source;  ///< -1: unmatched
  std::size_t matches = 0;
  std::int64_t energy = 0;                      ///< matched costs + threshold * (sources - matches)
  std::vector<std::int64_t> source_potentials;  ///< u, in [0, threshold]
  std::vector<std::int64_t> target_potentials;  ///< v, in [-threshold, 0]
};

/// The largest threshold for which no sum of costs, potentials or path lengths leaves 64 bits.
std::int64_t max_assignment_threshold(std::size_t sources, std::size_t targets);

/// The one-to-one assignment of least energy (Eq. 1), in which a source may also stay unmatched at the cost
/// `threshold`: the optimum of the padded problem of Eq. 5 without the padding. Exact, on one thread; among equal
/// optima the same input always gives the same one. Edges sorted by (source, target) without duplicates, each cost in
/// [0, threshold). Throws InvalidArgument otherwise, and when the threshold is not in [0, max_assignment_threshold].
Assignment solve_assignment(std::size_t sources, std::size_t targets, std::span<const AssignmentEdge> edges,
                            std::int64_t threshold);

/// Proves that `assignment` is an optimal answer to the problem: a one-to-one matching along the edges, potentials that
/// are dual feasible (0 <= u <= threshold, -threshold <= v <= 0, u + v <= cost), and energy = sum of u + sum of v.
/// Throws InvalidArgument for a problem that `solve_assignment` rejects.
bool certificate_holds(std::size_t sources, std::size_t targets, std::span<const AssignmentEdge> edges,
                       std::int64_t threshold, const Assignment& assignment);

}  // namespace igsp
