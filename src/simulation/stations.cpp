#include "simulation/stations.hpp"

#include <fmt/format.h>

#include <numbers>
#include <optional>

#include "igsp/errors.hpp"
#include "simulation/scanner.hpp"

namespace igsp::simulation {
namespace {

using Eigen::Vector3d;

constexpr double sensor_height = 1.6;      // a tripod
constexpr double camera_distance = 5.0;    // range camera from the origin, in radii of the scene
constexpr double same_surface = 0.02;      // a line of sight may end this share of its length before the point, ...
constexpr double same_surface_min = 0.15;  // ... or this much [m]: leaves of one clump count as one surface
constexpr int visibility_rays = 600;
constexpr int places_per_station = 24;
constexpr int restarts = 24;

bool is_free(const Scene& scene, const Vector3d& sensor) {
  for (int i = 0; i < 24; ++i) {
    const double azimuth = i * (std::numbers::pi / 12.0);
    for (const double elevation : {-0.9, -0.5, 0.0, 0.6}) {
      if (scene.surfaces.first_hit({sensor, direction_of(azimuth, elevation)}, scene.min_clearance)) return false;
    }
  }
  const Hit below = scene.surfaces.first_hit({sensor, -Vector3d::UnitZ()}, 2.0 * sensor_height);
  return std::abs(below.distance - sensor_height) < 0.15;  // the tripod stands on the ground, not on a table
}

std::optional<Vector3d> sensor_at(const Scene& scene, double x, double y) {
  if (!scene.station_area.contains(Eigen::Vector2d{x, y})) return {};
  const Vector3d sensor{x, y, scene.ground(x, y) + sensor_height};
  if (!is_free(scene, sensor)) return {};
  return sensor;
}

Points visible_points(const Scene& scene, const Vector3d& sensor) {
  Points points;
  for (const Vector3d& direction : scan_directions(visibility_rays)) {
    const Hit hit = scene.surfaces.first_hit({sensor, direction}, scene.max_range);
    if (hit) points.push_back(sensor + hit.distance * direction);
  }
  return points;
}

double share_seen(const Scene& scene, const Points& points, const Vector3d& sensor) {
  int seen = 0;
  for (const Vector3d& point : points) {
    const Vector3d sight = point - sensor;
    const double length = sight.norm(), tolerance = std::max(same_surface_min, same_surface * length);
    if (length > scene.max_range) continue;
    seen += !scene.surfaces.first_hit({sensor, sight / length}, length - tolerance);
  }
  return points.empty() ? 0.0 : static_cast<double>(seen) / static_cast<double>(points.size());
}

struct Chain {
  Points sensors;
  double worst = 0.0;  ///< largest difference of a link's mutual visibility from the wanted one
};

/// Adds the best of some random places at `distance` from the last station; false when none is free.
bool extend(const Scene& scene, double distance, double wanted, Random& random, Chain& chain) {
  const Vector3d last = chain.sensors.back();
  const Points seen = visible_points(scene, last);
  double best = std::numeric_limits<double>::infinity();
  Vector3d chosen;
  for (int i = 0; i < places_per_station; ++i) {
    const double azimuth = random.angle();
    const double dx = distance * std::cos(azimuth), dy = distance * std::sin(azimuth);
    const auto place = sensor_at(scene, last.x() + dx, last.y() + dy);
    if (!place) continue;
    double nearest = distance;
    for (const Vector3d& other : chain.sensors) nearest = std::min(nearest, (*place - other).norm());
    const double visibility = std::min(share_seen(scene, seen, *place),  //
                                       share_seen(scene, visible_points(scene, *place), last));
    const double walked_back = 1.0 - nearest / distance;
    const double difference = std::abs(visibility - wanted) + walked_back;
    if (difference < best) best = difference, chosen = *place;
  }
  if (best == std::numeric_limits<double>::infinity()) return false;
  chain.sensors.push_back(chosen);
  chain.worst = std::max(chain.worst, best);
  return true;
}

std::optional<Chain> walk(const Scene& scene, int count, double distance, double wanted, Random& random) {
  Chain chain;
  for (int i = 0; i < 200 && chain.sensors.empty(); ++i) {
    const Eigen::Vector2d& low = scene.station_area.min();
    const Eigen::Vector2d& high = scene.station_area.max();
    const double x = random.uniform(low.x(), high.x()), y = random.uniform(low.y(), high.y());
    if (const auto place = sensor_at(scene, x, y)) chain.sensors.push_back(*place);
  }
  if (chain.sensors.empty()) return {};
  while (chain.sensors.size() < static_cast<std::size_t>(count)) {
    if (!extend(scene, distance, wanted, random, chain)) return {};
  }
  return chain;
}

std::vector<Transformation> place_scanners(const Scene& scene, int count, double distance, Random& random) {
  const double wanted = random.uniform(scene.min_visibility, scene.max_visibility), good_enough = 0.06;
  std::optional<Chain> best;
  for (int i = 0; i < restarts && (!best || best->worst > good_enough); ++i) {
    const auto chain = walk(scene, count, distance, wanted, random);
    if (chain && (!best || chain->worst < best->worst)) best = chain;
  }
  if (!best) {
    throw InvalidArgument(fmt::format(
        "station_distance {} m with {} stations: this scene has no free places so far apart; its own distance is {} m",
        distance, count, scene.station_distance));
  }
  std::vector<Transformation> poses;
  for (const Vector3d& s : best->sensors) poses.push_back(standing_at(s.x(), s.y(), s.z(), random.angle()));
  return poses;
}

/// Cameras on a great circle that wanders a little, each with arbitrary axes.
std::vector<Transformation> place_cameras(const Scene& scene, int count, double distance, Random& random) {
  const double from_origin = camera_distance * scene.radius;
  if (distance > 2.0 * from_origin) {
    throw InvalidArgument(
        fmt::format("station_distance {} m is out of range (0, {}] for this scene", distance, 2.0 * from_origin));
  }
  const double step = 2.0 * std::asin(distance / (2.0 * from_origin));
  Vector3d direction = random.direction();
  Vector3d axis = direction.cross(random.direction()).normalized();
  std::vector<Transformation> poses;
  for (int i = 0; i < count; ++i) {
    Transformation pose = Transformation::Identity();
    pose.linear() = random.rotation();
    pose.translation() = from_origin * direction;
    poses.push_back(pose);
    axis = Eigen::AngleAxisd(0.1 * random.normal(), direction) * axis;  // stays perpendicular to the direction
    direction = Eigen::AngleAxisd(step, axis) * direction;
  }
  return poses;
}

}  // namespace

std::vector<Transformation> place_stations(const Scene& scene, int count, double distance, Random& random) {
  if (distance == 0.0) distance = scene.station_distance;
  if (scene.sensor == Sensor::terrestrial_scanner) return place_scanners(scene, count, distance, random);
  return place_cameras(scene, count, distance, random);
}

}  // namespace igsp::simulation
