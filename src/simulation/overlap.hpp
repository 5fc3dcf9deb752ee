#pragma once

#include "igsp/simulation.hpp"

namespace igsp::simulation {

/// Distance in the world from every point of `a` to the nearest point of `b`; infinity when `b` is empty.
std::vector<double> nearest_distances(const SimulatedScan& a, const SimulatedScan& b);

/// Share of the points of `a` that have a point of `b` within `radius` in the world, [0, 1].
double overlap_of(const SimulatedScan& a, const SimulatedScan& b, double radius);

}  // namespace igsp::simulation
