#pragma once

#include <vector>

#include "network/cycles.hpp"

namespace igsp {

/// Grows components by joining two at a time, the best supported first. All links between two components vote for a
/// relative pose; they are joined where the strongest group of links that agree outweighs every other. A group of one
/// link without any loop joins only if nothing better is left and it may stand alone. Returns the links of the forest
/// in the order in which they joined.
std::vector<std::size_t> spanning_forest(const LinkGraph& graph, const std::vector<CycleSupport>& support);

/// The chain of the forest's links from one scan to another; empty if there is none or both are the same.
std::vector<LinkStep> forest_path(const LinkGraph& graph, const std::vector<std::vector<std::size_t>>& forest_links,
                                  std::size_t from, std::size_t to);

/// The forest's links by scan.
std::vector<std::vector<std::size_t>> links_by_scan(const LinkGraph& graph, std::span<const std::size_t> links);

}  // namespace igsp
