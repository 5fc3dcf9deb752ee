#pragma once

#include <functional>
#include <span>
#include <vector>

#include "igsp/network.hpp"
#include "network/feature_shelf.hpp"
#include "network/measured_graph.hpp"

namespace igsp {

/// Registers pairs in rounds, the likeliest first: what the network as it stands says must overlap, then scans that are
/// alike by their features. A scan with enough links that loops confirm, or with too many tries that led nowhere, asks
/// for no more. `network` holds the scans; links come in the order of all_pairs. The rest as for register_pairs.
std::vector<NetworkLink> register_likely_pairs(const Network& network, FeatureShelf& features,
                                               std::span<const ScanShape> shapes, const NetworkOptions& options,
                                               const PairStore& store, const std::function<void(double)>& report);

}  // namespace igsp
