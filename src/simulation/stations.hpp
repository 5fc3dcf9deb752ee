#pragma once

#include <vector>

#include "igsp/point_cloud.hpp"
#include "simulation/scene.hpp"

namespace igsp::simulation {

/// Poses of `count` stations, neighbours `distance` apart (0: the scene's own), placed so that each sees a good part,
/// but not all, of what its predecessor sees. Throws InvalidArgument when the scene has no such places.
std::vector<Transformation> place_stations(const Scene& scene, int count, double distance, Random& random);

}  // namespace igsp::simulation
