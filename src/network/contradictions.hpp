#pragma once

#include <span>
#include <vector>

#include "igsp/network.hpp"
#include "network/measured_graph.hpp"
#include "network/seen_space.hpp"

namespace igsp {

/// Asks the free space of all scans of a component against each other where the network has them, of those that come
/// near each other. The worst first.
std::vector<NetworkContradiction> contradictions_at(const Network& network, std::span<const ScanShape> shapes,
                                                    SeenSpace& space);

/// Of the links that are used, those between two groups of scans that contradict each other more than these links speak
/// for being where they are; indices of links, empty: none. `contradictions` as above.
std::vector<std::size_t> contradicted_links(const Network& network,
                                            const std::vector<NetworkContradiction>& contradictions);

}  // namespace igsp
