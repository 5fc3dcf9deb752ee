#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "igsp/simulation.hpp"

namespace igsp::calibration {

/// What a pair can teach the verdict.
enum class Kind {
  ordinary,   ///< one scene, one right answer
  different,  ///< two scenes: every answer is wrong
  ambiguous,  ///< symmetric, repetitive, endless or noise in a box: several answers fit, or a whole family
};
std::string_view to_string(Kind kind);

/// How a pair is made; everything follows from (number of the pair, seed of the run).
struct Recipe {
  Kind kind = Kind::ordinary;
  std::string source_scene, target_scene;
  std::uint64_t source_seed = 0, target_seed = 0;
  int points = 0;                ///< per cloud, about
  double noise = 0;              ///< [m]
  double station_distance = 0;   ///< [m]; 0: the scene's own
  double field_of_view_deg = 0;  ///< horizontal; 0: all around
  double thinning = 1;           ///< share of the source's points that is kept

  bool is_one_scene() const { return source_scene == target_scene && source_seed == target_seed; }
};

struct Pair {
  Recipe recipe;
  SimulatedScan source, target;  ///< the source already moved, its pose with it
  Transformation truth;          ///< target_from_source; meaningless between two scenes
};

Pair make_pair(std::uint64_t number, std::uint64_t seed);

}  // namespace igsp::calibration
