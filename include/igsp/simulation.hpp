#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp {

struct SimulationOptions {
  int stations = 2;     ///< [1, 64]
  int points = 200000;  ///< per station, about
  std::optional<double> noise =
      {};  ///< standard deviation along the ray [m]; none: the scene's own, 5 mm ("object": 0.1 mm)
  double station_distance = 0;  ///< between neighbouring stations [m]; 0: the scene's own
  std::uint64_t seed = 7;       ///< every seed is another scene
};

/// One scan in the scanner's own frame, and where the scanner stood.
struct SimulatedScan {
  operator Scan() const { return {points, viewpoint}; }

  Points points;
  Transformation world_from_scanner = Transformation::Identity();
  std::optional<Eigen::Vector3d> viewpoint;  ///< the origin; none where the points lie on no surface
};

/// Scans of a simulated "park" or "indoor" by a levelled terrestrial scanner of unknown yaw, or of an "object" of 0.2 m
/// by a range camera in any pose, at several stations, by ray casting. Deterministic in the options. Throws
/// InvalidArgument (unknown scene, option out of range, no free places as far apart as station_distance asks).
std::vector<SimulatedScan> simulate(std::string_view scene, const SimulationOptions& options = {});

}  // namespace igsp
