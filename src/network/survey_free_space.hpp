#pragma once

#include <optional>
#include <span>
#include <vector>

#include "igsp/network.hpp"
#include "registration/prepared_cloud.hpp"

namespace igsp {

/// The scans of a network, ready to be looked at from each other's viewpoints; only those that lie in one frame with
/// others. Pairs are looked at where they lie in the network, not only where they were registered: a scan in the wrong
/// room may agree with the neighbour that put it there and stand in what a third scanner saw to be empty.
class SurveyFreeSpace {
 public:
  SurveyFreeSpace(std::span<const Features* const> features, double voxel_size);

  /// Among the links that are in no loop, the one to give up: of those between two scans that contradict each other
  /// clearly, the least confident; none where nothing is contradicted, or only within loops.
  std::optional<std::size_t> contradicted_link(const Network& network);

 private:
  const PreparedCloud& prepared(std::size_t scan);

  std::span<const Features* const> features_;
  double unit_;
  std::vector<Features> scaled_;
  std::vector<std::optional<PreparedCloud>> prepared_;
};

}  // namespace igsp
