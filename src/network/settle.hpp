#pragma once

#include <span>
#include <vector>

#include "igsp/network.hpp"
#include "network/measured_graph.hpp"
#include "network/seen_space.hpp"

namespace igsp {

/// Decides, then asks the free space of all scans against each other where this puts them. Links that it speaks against
/// are rejected in `links` and the rest is decided anew, until it speaks against none. `start` holds the scans.
Network settled_network(const Network& start, std::vector<NetworkLink>& links, std::span<const ScanShape> shapes,
                        SeenSpace& space, const NetworkOptions& options);

}  // namespace igsp
