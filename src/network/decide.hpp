#pragma once

#include "igsp/network.hpp"
#include "network/measured_graph.hpp"
#include "network/seen_space.hpp"

namespace igsp {

/// From pairs to one answer: `network` holds scans and links as registered; this decides which links stand and where
/// every scan lies, and fills in the rest. `shapes` by scan. `space`: none where nobody can be asked.
void decide(Network& network, std::span<const ScanShape> shapes, SeenSpace* space, const NetworkOptions& options);

/// How far the pairs' own answers are from the network's: per link and for all that are used.
void measure_residuals(Network& network, std::span<const ScanShape> shapes);

}  // namespace igsp
