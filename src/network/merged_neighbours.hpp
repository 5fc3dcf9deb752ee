#pragma once

#include <functional>
#include <set>
#include <vector>

#include "igsp/network.hpp"
#include "network/feature_shelf.hpp"

namespace igsp {

/// Registers scans that lie in no frame against the merged clouds of frames: what a scan shares with each of its
/// neighbours may be too little where it is enough with all of them.
class MergedNeighbours {
 public:
  MergedNeighbours(FeatureShelf& features, const NetworkOptions& options) : features_(features), options_(options) {}

  /// Every scan without a frame with every frame that it was not tried with as it is now. `report` gets the share done
  /// and may throw to stop.
  std::vector<NetworkLink> next(const Network& network, const std::function<void(double)>& report);

 private:
  FeatureShelf& features_;
  const NetworkOptions& options_;
  std::set<std::vector<std::size_t>> tried_;  // the scan, then those of the merged cloud
};

}  // namespace igsp
