#include "network/components.hpp"

#include <algorithm>
#include <numeric>

namespace igsp {
namespace {

using Neighbours = std::vector<std::vector<std::pair<std::size_t, std::size_t>>>;  // node, edge

Neighbours neighbours_of(std::size_t nodes, std::span<const Edge> edges) {
  Neighbours neighbours(nodes);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    neighbours[edges[e].first].emplace_back(edges[e].second, e);
    neighbours[edges[e].second].emplace_back(edges[e].first, e);
  }
  return neighbours;
}

// Depth-first search without recursion: a chain of any length.
struct Visit {
  std::size_t node, edge, next;
};

}  // namespace

std::vector<std::vector<std::size_t>> connected_components(std::size_t nodes, std::span<const Edge> edges) {
  std::vector<std::size_t> root(nodes);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& [a, b] : edges) root[std::max(find(a), find(b))] = std::min(find(a), find(b));
  std::vector<std::vector<std::size_t>> members(nodes);
  for (std::size_t i = 0; i < nodes; ++i) members[find(i)].push_back(i);
  std::erase_if(members, [](const auto& scans) { return scans.empty(); });
  std::stable_sort(members.begin(), members.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return members;
}

std::size_t anchor_of(const std::vector<std::size_t>& component, const std::optional<std::size_t>& fixed) {
  return fixed && std::ranges::binary_search(component, *fixed) ? *fixed : component.front();
}

std::vector<bool> bridges(std::size_t nodes, std::span<const Edge> edges) {
  const Neighbours neighbours = neighbours_of(nodes, edges);
  const std::size_t none = edges.size();
  std::vector<std::size_t> entered(nodes, 0), lowest(nodes, 0);
  std::vector<bool> is_bridge(edges.size(), false);
  std::size_t clock = 0;
  for (std::size_t start = 0; start < nodes; ++start) {
    if (entered[start] != 0) continue;
    entered[start] = lowest[start] = ++clock;
    std::vector<Visit> stack = {{start, none, 0}};
    while (!stack.empty()) {
      Visit& here = stack.back();
      if (here.next < neighbours[here.node].size()) {
        const auto [node, edge] = neighbours[here.node][here.next++];
        if (edge == here.edge) continue;
        if (entered[node] != 0) {
          lowest[here.node] = std::min(lowest[here.node], entered[node]);
        } else {
          entered[node] = lowest[node] = ++clock;
          stack.push_back({node, edge, 0});
        }
        continue;
      }
      const Visit done = here;
      stack.pop_back();
      if (stack.empty()) continue;
      const std::size_t parent = stack.back().node;
      lowest[parent] = std::min(lowest[parent], lowest[done.node]);
      is_bridge[done.edge] = lowest[done.node] > entered[parent];
    }
  }
  return is_bridge;
}

}  // namespace igsp
