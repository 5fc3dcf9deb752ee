#pragma once

#include <span>
#include <vector>

#include "network/link_graph.hpp"

namespace igsp {

/// Poses of scans, and what holds them. Lengths in voxels, like the graph's.
struct BalancedPoses {
  std::vector<Transformation> world_from_scan;
  std::vector<double> errors;        ///< per link: chi-square against its tolerance, as loop_error
  std::vector<Matrix6> covariances;  ///< per scan: step about its centre, in its own frame; 0 for anchors
};

/// Spreads the errors of all links over the poses: Gauss-Newton on SE(3) with the Geman-McClure loss on each link's
/// error against its tolerance. It never starts cold: the poses come along the forest's links from the `anchors`, one
/// scan in each of its trees (it stays where it is, at the identity), and a link that closes a long loop is first
/// given the tolerance of the whole loop. Links between trees take no part.
BalancedPoses balance_poses(const LinkGraph& graph, std::span<const std::size_t> forest,
                            std::span<const std::size_t> anchors);

}  // namespace igsp
