#pragma once

#include <span>
#include <vector>

#include "igsp/network.hpp"
#include "network/seen_space.hpp"
#include "network/spanning_forest.hpp"

namespace igsp {

/// How far the points of a scan reach.
struct ScanShape {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centroid, in the scan's frame
  double size = 0;                                   ///< root mean square distance from it
  double reach = 0;  ///< distance of what is farthest from it, of the points and of where the scanner stood
};
ScanShape shape_of(const Features& features);

/// The pairs among `links` that are registered, may be right or may find witnesses, as a graph in voxels, and which
/// link each of its links is. What is rejected already, or what the free space speaks against clearly, is left out.
struct MeasuredGraph {
  LinkGraph graph;
  std::vector<std::size_t> link_of;  ///< per link of the graph
};

MeasuredGraph measured_graph(std::span<const NetworkLink> links, std::span<const ScanShape> shapes, double voxel_size,
                             const NetworkOptions& options);

/// Without the refused pairs that the forest did not need; renumbers the links of the forest.
MeasuredGraph without_unused_refused(const MeasuredGraph& measured, std::span<const NetworkLink> links,
                                     const NetworkOptions& options, Forest& forest);

/// True of a pair, though refused by itself, that shares many matches, that the surfaces fix and that the free space
/// does not speak against; unless it was refused for something that cannot be.
bool may_be_right(const NetworkLink& link, const NetworkOptions& options);

/// What two scans say that would be seen so: in favour where their surfaces meet and nothing of one is in the other's
/// way. Where they do not meet, each may just be hidden from the other.
Witness witness_of(const SeenTogether& seen);

/// Of free space: beyond it others must confirm a pair, for right poses have at most half of it but for people and
/// leaves.
inline constexpr double doubtful_violation = 0.01;

/// Log odds of a confidence as links count them in votes, within bounds.
double vote_of(double confidence);

/// True of a link by which the network has its scans where they are.
bool is_used(const NetworkLink& link);

/// True where the free space speaks against a pair, so that others must confirm it.
bool is_doubtful(const NetworkLink& link);

/// True where the free space forbids a pair, whatever else speaks for it.
bool contradicts_free_space(const NetworkLink& link);

}  // namespace igsp
