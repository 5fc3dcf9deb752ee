#pragma once

#include <vector>

#include "network/link_graph.hpp"

namespace igsp {

/// What loops of three links say of a link.
struct CycleSupport {
  std::size_t triangles = 0;  ///< those that close
  std::size_t open = 0;       ///< those that do not: one of their three links is wrong
  double support = 0;         ///< sum of the weaker other link's weight, for a triangle that closes exactly
};

/// One entry per link.
std::vector<CycleSupport> cycle_support(const LinkGraph& graph);

}  // namespace igsp
