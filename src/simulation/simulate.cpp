#include <fmt/format.h>

#include <cmath>

#include "igsp/errors.hpp"
#include "igsp/simulation.hpp"
#include "simulation/scanner.hpp"
#include "simulation/scene.hpp"
#include "simulation/stations.hpp"

namespace igsp {
namespace {

constexpr int max_stations = 64;
constexpr int most_points_a_scan = 100'000'000;

void require(bool valid, std::string_view name, double value, std::string_view range) {
  if (!valid) throw InvalidArgument(fmt::format("{} = {} is out of range {}", name, value, range));
}

void validate(const SimulationOptions& options) {
  require(options.stations >= 1 && options.stations <= max_stations, "stations", options.stations,
          fmt::format("[1, {}]", max_stations));
  require(options.points >= 1 && options.points <= most_points_a_scan, "points", options.points,
          fmt::format("[1, {}]", most_points_a_scan));
  const double noise = options.noise.value_or(0.0), distance = options.station_distance;
  require(std::isfinite(noise) && noise >= 0.0, "noise", noise, "[0, infinity)");
  require(std::isfinite(distance) && distance >= 0.0, "station_distance", distance, "[0, infinity)");
}

}  // namespace

std::vector<SimulatedScan> simulate(std::string_view scene_name, const SimulationOptions& options) {
  validate(options);
  const simulation::Scene scene = simulation::build_scene(scene_name, options.seed);
  simulation::Random random(options.seed, 1);  // another sequence than the scene's
  std::vector<SimulatedScan> scans;
  for (const Transformation& pose :
       simulation::place_stations(scene, options.stations, options.station_distance, random)) {
    const simulation::Random of_station(random.bits());
    std::optional<Eigen::Vector3d> viewpoint;
    if (scene.sensor != simulation::Sensor::none) viewpoint = Eigen::Vector3d::Zero();
    scans.push_back({simulation::scan(scene, pose, options.points, options.noise.value_or(scene.noise), of_station),
                     pose, viewpoint});
  }
  return scans;
}

}  // namespace igsp
