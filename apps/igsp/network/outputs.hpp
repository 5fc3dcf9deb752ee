#pragma once

#include <string>

#include "igsp/network.hpp"
#include "report/json.hpp"

namespace igsp::cli {

/// scan,component,qw,qx,qy,qz,tx,ty,tz: world_from_scan, one world per component.
std::string poses_csv(const Network& network);

/// A line per pair that was tried, then per second look.
std::string links_csv(const Network& network);

/// Index, tx, ty, tz, qx, qy, qz, qw: as the tools for trajectories read it.
std::string poses_tum(const Network& network);

/// VERTEX_SE3:QUAT and EDGE_SE3:QUAT of the links that are used, as pose graph optimisers read them. Vertices are the
/// scans in their order; an edge runs from target to source, its information about the source's origin.
std::string network_g2o(const Network& network);

/// A link but for its pose.
Json link_summary(const NetworkLink& link);

Json cycle_summary(const NetworkCycle& cycle);
Json contradiction_summary(const NetworkContradiction& pair);

/// Without second looks.
std::size_t pairs_tried(const Network& network);

/// Everything.
Json network_json(const Network& network, const NetworkOptions& options);

/// Two lines: what lies in one frame and what does not, and what became of the pairs.
std::string network_summary(const Network& network);

}  // namespace igsp::cli
