#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp {

struct SimulationOptions {
  int stations = 2;
  int points = 200000;           ///< per station, about
  double noise = 0.005;          ///< standard deviation along the ray [m]
  double station_distance = 0;   ///< between neighbouring stations [m]; 0: the scene's own
  std::uint64_t seed = 7;
};

/// One scan in the scanner's own frame (its origin is the sensor), and where the scanner stood.
struct SimulatedScan {
  Points points;
  Transformation world_from_scanner = Transformation::Identity();
};

/// Scans of a simulated "park", "indoor" or "object" by a terrestrial scanner at several stations, by ray casting.
/// Deterministic in the options. Throws InvalidArgument.
std::vector<SimulatedScan> simulate(std::string_view scene, const SimulationOptions& options = {});

}  // namespace igsp
