#include "matching/assignment_problem.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <string>

#include "igsp/errors.hpp"

namespace igsp {
namespace {

using Entry = AssignmentRows::Entry;

bool cheaper(const Entry& a, const Entry& b) {
  return a.cost < b.cost || (a.cost == b.cost && a.column < b.column);
}

/// For entries that are nearly in order.
void insertion_sort(std::span<Entry> entries) {
  for (std::size_t i = 1; i < entries.size(); ++i) {
    const Entry entry = entries[i];
    std::size_t gap = i;
    for (; gap > 0 && cheaper(entry, entries[gap - 1]); --gap) entries[gap] = entries[gap - 1];
    entries[gap] = entry;
  }
}

/// Distributes the edges over buckets of cost first, three times as fast as a comparison sort of the row alone.
void sort_row(std::span<const AssignmentEdge> edges, std::span<Entry> entries) {
  if (edges.empty()) return;
  std::int64_t least = edges.front().cost, most = least;
  for (const AssignmentEdge& edge : edges) {
    least = std::min(least, edge.cost);
    most = std::max(most, edge.cost);
  }
  constexpr int bucket_bits = 7;
  const int range_bits = std::bit_width(static_cast<std::uint64_t>(most - least));
  const int shift = std::max(0, range_bits - bucket_bits);
  const auto bucket = [&](const AssignmentEdge& edge) { return (edge.cost - least) >> shift; };

  std::array<std::uint32_t, (1 << bucket_bits) + 1> place{};
  for (const AssignmentEdge& edge : edges) ++place[bucket(edge) + 1];
  const std::uint32_t largest_bucket = *std::max_element(place.begin(), place.end());
  std::partial_sum(place.begin(), place.end(), place.begin());
  for (const AssignmentEdge& edge : edges) {
    entries[place[bucket(edge)]++] = {edge.cost, static_cast<std::int32_t>(edge.target)};
  }
  if (shift == 0) return;
  constexpr std::uint32_t most_for_insertion = 32;
  if (largest_bucket > most_for_insertion) return std::sort(entries.begin(), entries.end(), cheaper);
  insertion_sort(entries);
}

void check_size(std::size_t sources, std::size_t targets, std::int64_t threshold) {
  constexpr std::size_t max_nodes = std::numeric_limits<std::int32_t>::max();
  if (sources > max_nodes || targets > max_nodes) {
    throw InvalidArgument("assignment: " + std::to_string(std::max(sources, targets)) + " nodes, at most " +
                          std::to_string(max_nodes));
  }
  const std::int64_t max_threshold = max_assignment_threshold(sources, targets);
  if (threshold < 0 || threshold > max_threshold) {
    throw InvalidArgument("assignment: threshold " + std::to_string(threshold) + " outside [0, " +
                          std::to_string(max_threshold) + "]");
  }
}

}  // namespace

std::int64_t max_assignment_threshold(std::size_t sources, std::size_t targets) {
  // Potentials stay within one threshold and path lengths within four; the energy adds one threshold per source.
  return std::numeric_limits<std::int64_t>::max() / static_cast<std::int64_t>(4 + sources + targets);
}

void check_assignment_problem(std::size_t sources, std::size_t targets, std::span<const AssignmentEdge> edges,
                              std::int64_t threshold) {
  check_size(sources, targets, threshold);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const AssignmentEdge& edge = edges[e];
    const bool ordered = e == 0 || edges[e - 1].source < edge.source ||
                         (edges[e - 1].source == edge.source && edges[e - 1].target < edge.target);
    if (ordered && edge.source < sources && edge.target < targets && edge.cost >= 0 && edge.cost < threshold) continue;
    throw InvalidArgument("assignment: edge " + std::to_string(e) + " (source " + std::to_string(edge.source) +
                          ", target " + std::to_string(edge.target) + ", cost " + std::to_string(edge.cost) +
                          ") is out of order or not within " + std::to_string(sources) + " x " +
                          std::to_string(targets) + " nodes and costs in [0, " + std::to_string(threshold) + ")");
  }
}

std::vector<AssignmentEdge> transposed(std::size_t targets, std::span<const AssignmentEdge> edges) {
  std::vector<std::size_t> next(targets + 1, 0);
  for (const AssignmentEdge& edge : edges) ++next[edge.target + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<AssignmentEdge> result(edges.size());
  for (const AssignmentEdge& edge : edges) result[next[edge.target]++] = {edge.target, edge.source, edge.cost};
  return result;
}

AssignmentRows::AssignmentRows(std::size_t sources, std::span<const AssignmentEdge> edges)
    : first_(sources + 1, 0), entries_(edges.size()) {
  for (const AssignmentEdge& edge : edges) ++first_[edge.source + 1];
  for (std::size_t row = 0; row < sources; ++row) {
    const std::size_t size = first_[row + 1];
    first_[row + 1] += first_[row];
    sort_row(edges.subspan(first_[row], size), std::span(entries_).subspan(first_[row], size));
  }
}

}  // namespace igsp
