#include <algorithm>
#include <numeric>

#include "matching/assignment.hpp"
#include "matching/assignment_problem.hpp"

namespace igsp {
namespace {

bool all_within(const std::vector<std::int64_t>& potentials, std::size_t size, std::int64_t low, std::int64_t high) {
  return potentials.size() == size &&
         std::all_of(potentials.begin(), potentials.end(), [&](std::int64_t p) { return low <= p && p <= high; });
}

/// A target or -1 for every source, and no target twice.
bool is_one_to_one(const std::vector<std::int32_t>& target_of_source, std::size_t sources, std::size_t targets) {
  if (target_of_source.size() != sources) return false;
  std::vector<bool> taken(targets, false);
  for (const std::int32_t target : target_of_source) {
    if (target == -1) continue;
    if (target < 0 || static_cast<std::size_t>(target) >= targets || taken[target]) return false;
    taken[target] = true;
  }
  return true;
}

std::int64_t sum(const std::vector<std::int64_t>& values) {
  return std::accumulate(values.begin(), values.end(), std::int64_t{0});
}

}  // namespace

bool certificate_holds(std::size_t sources, std::size_t targets, std::span<const AssignmentEdge> edges,
                       std::int64_t threshold, const Assignment& assignment) {
  check_assignment_problem(sources, targets, edges, threshold);
  const std::vector<std::int64_t>& u = assignment.source_potentials;
  const std::vector<std::int64_t>& v = assignment.target_potentials;
  if (!is_one_to_one(assignment.target_of_source, sources, targets)) return false;
  if (!all_within(u, sources, 0, threshold) || !all_within(v, targets, -threshold, 0)) return false;

  std::int64_t matched_cost = 0;
  std::size_t matched_edges = 0;
  for (const AssignmentEdge& edge : edges) {
    if (u[edge.source] + v[edge.target] > edge.cost) return false;
    if (assignment.target_of_source[edge.source] == static_cast<std::int64_t>(edge.target)) {
      matched_cost += edge.cost;
      ++matched_edges;
    }
  }
  const std::size_t unmatched = std::count(assignment.target_of_source.begin(), assignment.target_of_source.end(), -1);
  const std::int64_t energy = matched_cost + threshold * static_cast<std::int64_t>(unmatched);
  return matched_edges == sources - unmatched && assignment.matches == matched_edges && assignment.energy == energy &&
         energy == sum(u) + sum(v);
}

}  // namespace igsp
