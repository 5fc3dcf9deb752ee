#include "network/cycles.hpp"

#include <algorithm>
#include <map>
#include <span>

#include "estimation/robust_fit.hpp"

namespace igsp {
namespace {

// Two links from copies of the same room support each other, and both stand in what a scanner saw through.
bool proves_nothing(const LinkGraph& graph, std::span<const LinkStep> loop) {
  return std::ranges::count_if(loop, [&](const LinkStep& step) { return graph.links[step.link].is_doubtful; }) > 1;
}

LinkStep towards(const LinkGraph& graph, std::size_t link, std::size_t scan) {
  return {link, graph.links[link].target == scan};
}

}  // namespace

std::vector<Triangle> triangles(const LinkGraph& graph) {
  // Links of a scan to later ones, so that every triangle is met once, at its first scan.
  std::vector<std::map<std::size_t, std::size_t>> later(graph.centres.size());
  for (std::size_t l = 0; l < graph.links.size(); ++l) {
    if (graph.links[l].confirms_nothing) continue;
    const auto [first, second] = std::minmax(graph.links[l].source, graph.links[l].target);
    later[first].emplace(second, l);
  }
  std::vector<Triangle> found;
  for (std::size_t a = 0; a < later.size(); ++a) {
    for (const auto& [b, ab] : later[a]) {
      for (const auto& [c, bc] : later[b]) {
        const auto ac = later[a].find(c);
        if (ac == later[a].end()) continue;
        const std::array<LinkStep, 3> loop = {towards(graph, ab, b), towards(graph, bc, c),
                                              towards(graph, ac->second, a)};
        if (proves_nothing(graph, loop)) continue;
        found.push_back({{a, b, c}, {ab, bc, ac->second}, loop_error(graph, loop)});
      }
    }
  }
  return found;
}

std::vector<CycleSupport> cycle_support(const LinkGraph& graph, const std::vector<Triangle>& triangles) {
  std::vector<CycleSupport> found(graph.links.size());
  for (const Triangle& triangle : triangles) {
    // Right links agree far better than they must; what just closes may have done so by chance.
    const double trust = geman_mcclure_weight(triangle.error, max_loop_error / 9);
    for (int i = 0; i < 3; ++i) {
      CycleSupport& entry = found[triangle.links[i]];
      ++(triangle.closes() ? entry.triangles : entry.open);
      if (triangle.closes()) {
        entry.best_error = std::min(entry.best_error, triangle.error);
        entry.support += trust * std::min(graph.links[triangle.links[(i + 1) % 3]].weight,
                                          graph.links[triangle.links[(i + 2) % 3]].weight);
      }
    }
  }
  return found;
}

}  // namespace igsp
