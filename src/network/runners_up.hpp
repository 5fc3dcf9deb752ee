#pragma once

#include <vector>

#include "igsp/network.hpp"
#include "network/feature_shelf.hpp"
#include "network/measured_graph.hpp"

namespace igsp {

/// Looks again at pairs that the network did not use: where their second best pose is the one that the network has, or
/// could bring scans together that no pair did, it is refined and judged by itself. Of what `network` decided.
std::vector<NetworkLink> runners_up(const Network& network, FeatureShelf& features, std::span<const ScanShape> shapes,
                                    const NetworkOptions& options);

}  // namespace igsp
