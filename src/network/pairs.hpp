#pragma once

#include <functional>
#include <span>
#include <vector>

#include "igsp/network.hpp"
#include "network/feature_shelf.hpp"

namespace igsp {

/// Every pair of usable scans, the earlier one as target.
std::vector<ScanPair> all_pairs(const std::vector<NetworkScan>& scans);

/// Those given that are of usable scans, each once, as all_pairs has them. Throws InvalidArgument for a scan that is
/// not there or paired with itself.
std::vector<ScanPair> listed_pairs(const std::vector<NetworkScan>& scans, std::span<const ScanPair> given);

/// What a network keeps of a pair's answer; unconfirmed where it is registered.
NetworkLink link_of(const ScanPair& pair, const Result& result);

/// Registers pairs, several at a time, each on one thread. Of the features those of a few pairs are held at once.
/// The store is told of all of them first; what it has is taken from it, the rest is kept in it. `report` gets the
/// share done and may throw to stop.
std::vector<NetworkLink> register_pairs(std::span<const ScanPair> pairs, FeatureShelf& features, const Options& options,
                                        const PairStore& store, const std::function<void(double)>& report);

}  // namespace igsp
