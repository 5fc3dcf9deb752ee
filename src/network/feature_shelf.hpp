#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "igsp/network.hpp"

namespace igsp {

/// The features of all scans, some of them in memory: those asked for last. Others are asked of their source again. For
/// one thread; what it hands out stays as long as somebody holds it.
class FeatureShelf {
 public:
  /// `held`: how many scans, 0 for all.
  FeatureShelf(std::size_t scans, FeatureSource source, std::size_t held);

  /// Throws what the source throws.
  std::shared_ptr<const Features> get(std::size_t scan);

 private:
  FeatureSource source_;
  std::size_t held_;
  std::vector<std::shared_ptr<const Features>> features_;  // by scan
  std::deque<std::size_t> asked_;                          // those that are here, the latest last
};

}  // namespace igsp
