#pragma once

#include <functional>
#include <vector>

#include "network/cycles.hpp"

namespace igsp {

/// What two scans that no link connects say of a join that would put them so: whether one stands in what the other's
/// scanner saw through. Doubtful: hardly, but too much for a link that needs witnesses.
enum class Witness { none, in_favour, doubtful, against };
using WitnessQuestion =
    std::function<Witness(std::size_t source, std::size_t target, const Transformation& target_from_source)>;

struct Forest {
  std::vector<std::size_t> links;     ///< in the order in which they joined
  std::vector<bool> is_contradicted;  ///< by link of the graph: could have joined, but for a witness
};

/// Grows components by joining two at a time, the best supported first. All links between two components vote for a
/// relative pose; they are joined where the strongest group of links that agree outweighs every other. A group of one
/// link without any loop joins only if nothing better is left, it may stand alone or has the witnesses it needs, and
/// none is against it.
Forest spanning_forest(const LinkGraph& graph, const std::vector<CycleSupport>& support,
                       const WitnessQuestion& ask = {});

/// The chain of the forest's links from one scan to another; empty if there is none or both are the same.
std::vector<LinkStep> forest_path(const LinkGraph& graph, const std::vector<std::vector<std::size_t>>& forest_links,
                                  std::size_t from, std::size_t to);

/// The forest's links by scan.
std::vector<std::vector<std::size_t>> links_by_scan(const LinkGraph& graph, std::span<const std::size_t> links);

}  // namespace igsp
