#pragma once

#include <array>
#include <vector>

#include "network/link_graph.hpp"

namespace igsp {

/// What loops of three links say of a link.
struct CycleSupport {
  std::size_t triangles = 0;           ///< those that close
  std::size_t open = 0;                ///< those that do not: one of their three links is wrong
  double best_error = max_loop_error;  ///< squared, the smallest of those that close
  double support = 0;                  ///< sum of the weaker other link's weight, for a triangle that closes exactly
};

/// A loop of three links, none of it proven by copies of one room alone.
struct Triangle {
  std::array<std::size_t, 3> scans;  ///< ascending
  std::array<std::size_t, 3> links;
  double error;  ///< squared, see loop_error
  bool closes() const { return error < max_loop_error; }
};

/// All of them, by their scans.
std::vector<Triangle> triangles(const LinkGraph& graph);

/// One entry per link.
std::vector<CycleSupport> cycle_support(const LinkGraph& graph, const std::vector<Triangle>& triangles);

}  // namespace igsp
