#pragma once

#include "igsp/network.hpp"
#include "network/measured_graph.hpp"
#include "network/seen_space.hpp"

namespace igsp {

/// From pairs to one answer: `network` holds scans and links as registered; this decides which links stand and where
/// every scan lies, and fills in the rest. Links that are rejected already stay so. `shapes` by scan. `space`: none
/// where nobody can be asked.
void decide(Network& network, std::span<const ScanShape> shapes, SeenSpace* space, const NetworkOptions& options);

/// RMS displacement of the source's points between `target_from_source` and where the network has both scans.
double displacement(const Network& network, std::size_t source, std::size_t target,
                    const Transformation& target_from_source, const ScanShape& shape);

/// How far the pairs' own answers are from the network's: per link and for all that are used.
void measure_residuals(Network& network, std::span<const ScanShape> shapes);

}  // namespace igsp
