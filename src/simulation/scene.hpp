#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "igsp/point_cloud.hpp"
#include "simulation/bounding_volume_hierarchy.hpp"
#include "simulation/random.hpp"

namespace igsp::simulation {

enum class Sensor {
  terrestrial_scanner,  ///< levelled, 1.6 m above the ground, all around
  range_camera,         ///< looks at the world's origin from any side, like an object scanner
  none,                 ///< points that lie on no surface
};

/// What there is to scan, in metres, and how it is scanned. z is up.
struct Scene {
  BoundingVolumeHierarchy surfaces;
  Sensor sensor = Sensor::terrestrial_scanner;
  double noise = 0.005;  ///< standard deviation along the ray
  double max_range = 80.0;
  double min_clearance = 0.6;     ///< nothing stands nearer to a station
  double station_distance = 5.0;  ///< between neighbouring stations
  /// Neighbouring stations see this share of each other's points, between the bounds where the scene allows.
  double min_visibility = 0.6, max_visibility = 0.8;
  Eigen::AlignedBox2d station_area;  ///< where stations may stand
  std::function<double(double x, double y)> ground = [](double, double) { return 0.0; };
  double radius = 0.0;  ///< range camera and noise: everything lies in this sphere around the origin
};

/// Scenes by name, all usable through simulate(). What users are offered:
///   "park"    uneven lawn, path with kerbs, 20-60 trees, bushes, benches, lamp posts, a building at one side
///   "indoor"  rooms along a corridor, doors, windows, columns, furniture
///   "object"  a smooth asymmetric body of about 0.2 m
/// What only tests and the calibration of the verdict use, because no single right answer exists:
///   "plane"                flat ground and nothing else
///   "sphere", "cylinder"   of 0.2 m, seen by the range camera
///   "corridor"             endless within range: free along its direction
///   "square_room"          empty, four equal walls: four right answers
///   "repetitive_corridor"  endless, equal doors every few metres
///   "noise"                uniform random points in a box, drawn anew at every station: no right answer at all
/// Deterministic in (name, seed). Throws InvalidArgument for another name.
Scene build_scene(std::string_view name, std::uint64_t seed);

Scene build_park(Random& random);
Scene build_indoor(Random& random);
Scene build_object(Random& random);
Scene build_plane(Random& random);
Scene build_sphere(Random& random);
Scene build_cylinder(Random& random);
Scene build_corridor(Random& random);
Scene build_square_room(Random& random);
Scene build_repetitive_corridor(Random& random);
Scene build_noise(Random& random);

}  // namespace igsp::simulation
