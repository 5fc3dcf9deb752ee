#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "igsp/network.hpp"

namespace igsp {

using ScanPair = std::pair<std::size_t, std::size_t>;  ///< source, target

/// Every pair of usable scans, the earlier one as target.
std::vector<ScanPair> all_pairs(const std::vector<NetworkScan>& scans);

/// Registers pairs, several at a time, each on one thread. `features` by scan; only those of the pairs are looked at.
/// What the store has is taken from it, the rest is kept in it. `report` gets the share done and may throw to stop.
std::vector<NetworkLink> register_pairs(std::span<const ScanPair> pairs, std::span<const Features* const> features,
                                        const Options& options, const PairStore& store,
                                        const std::function<void(double)>& report);

}  // namespace igsp
