#include "simulation/scanner.hpp"

#include <algorithm>
#include <numbers>

#include "core/parallel.hpp"

namespace igsp::simulation {
namespace {

using Eigen::Vector3d;

constexpr double min_elevation = -60.0 * std::numbers::pi / 180.0;  // below stands the tripod
constexpr double max_elevation = 85.0 * std::numbers::pi / 180.0;
constexpr double jitter = 0.05;  // of a ray, in steps of the grid
constexpr int probe_rays = 20000;

/// A regular grid of rays over a rectangle of two coordinates: azimuth and elevation, or a camera's image.
struct RayGrid {
  double first_u, first_v, step_u, step_v;
  int columns, rows;
};

RayGrid make_grid(double low_u, double high_u, double low_v, double high_v, double count) {
  const double width = high_u - low_u, height = high_v - low_v;
  const int columns = std::max(1, static_cast<int>(std::lround(std::sqrt(count * width / height))));
  const int rows = std::max(1, static_cast<int>(std::lround(count / columns)));
  const double step_u = width / columns, step_v = height / rows;
  return {low_u + 0.5 * step_u, low_v + 0.5 * step_v, step_u, step_v, columns, rows};
}

RayGrid grid_for(const Scene& scene, const Transformation& world_from_scanner, double count) {
  if (scene.sensor == Sensor::terrestrial_scanner) {
    return make_grid(-std::numbers::pi, std::numbers::pi, min_elevation, max_elevation, count);
  }
  const double tangent = 1.05 * scene.radius / world_from_scanner.translation().norm();  // a margin around it
  return make_grid(-tangent, tangent, -tangent, tangent, count);
}

/// The camera's optical axis points at the world's origin, whatever its own axes are.
Eigen::Matrix3d camera_axes(const Transformation& world_from_scanner) {
  const Vector3d to_origin = -(world_from_scanner.linear().transpose() * world_from_scanner.translation()).normalized();
  return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), to_origin).toRotationMatrix();
}

/// The point that one ray returns, in the scanner's frame; false when it returns none.
bool measure(const Scene& scene, const Transformation& world_from_scanner, const Vector3d& direction, Vector3d& point) {
  const Ray ray{world_from_scanner.translation(), world_from_scanner.linear() * direction};
  const Hit hit = scene.surfaces.first_hit(ray, scene.max_range);
  if (!hit) return false;
  const Vector3d normal =
      normal_at(scene.surfaces.primitives()[hit.primitive], ray.origin + hit.distance * ray.direction);
  const double grazing = scene.sensor == Sensor::range_camera ? 0.15 : 0.02;  // cosine of the angle of incidence
  if (std::abs(normal.dot(ray.direction)) < grazing) return false;
  point = hit.distance * direction;
  return true;
}

Points cast(const Scene& scene, const Transformation& world_from_scanner, double count, double noise, Random random) {
  const RayGrid grid = grid_for(scene, world_from_scanner, count);
  const bool terrestrial = scene.sensor == Sensor::terrestrial_scanner;
  const Eigen::Matrix3d axes = terrestrial ? Eigen::Matrix3d::Identity() : camera_axes(world_from_scanner);
  const std::uint64_t seed = random.bits();
  std::vector<Points> columns(grid.columns);
  const auto sweep = [&](std::size_t begin, std::size_t end) {
    for (std::size_t column = begin; column < end; ++column) {
      Random draw(seed, column);  // one sequence a column: the threads' order does not matter
      for (int row = 0; row < grid.rows; ++row) {
        const double u = grid.first_u + (static_cast<double>(column) + jitter * draw.uniform(-1.0, 1.0)) * grid.step_u;
        const double v = grid.first_v + (row + jitter * draw.uniform(-1.0, 1.0)) * grid.step_v;
        const double error = noise * draw.normal();
        const Vector3d direction = terrestrial ? direction_of(u, v) : Vector3d(axes * Vector3d{u, v, 1.0}.normalized());
        Vector3d point;
        if (measure(scene, world_from_scanner, direction, point)) columns[column].push_back(point + error * direction);
      }
    }
  };
  parallel_blocks(columns.size(), 0, 16, sweep);
  Points points;
  for (const Points& column : columns) points.insert(points.end(), column.begin(), column.end());
  return points;
}

/// Fresh random points of the cube inscribed in the scene's sphere.
Points scatter(const Scene& scene, const Transformation& world_from_scanner, int count, Random random) {
  const double half = scene.radius / std::sqrt(3.0);
  const Transformation scanner_from_world = world_from_scanner.inverse();
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-half, half), y = random.uniform(-half, half), z = random.uniform(-half, half);
    points.push_back(scanner_from_world * Vector3d{x, y, z});
  }
  return points;
}

}  // namespace

Vector3d direction_of(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

Points scan_directions(int count) {
  const RayGrid grid = make_grid(-std::numbers::pi, std::numbers::pi, min_elevation, max_elevation, count);
  Points directions;
  for (int column = 0; column < grid.columns; ++column) {
    for (int row = 0; row < grid.rows; ++row) {
      directions.push_back(direction_of(grid.first_u + column * grid.step_u, grid.first_v + row * grid.step_v));
    }
  }
  return directions;
}

Points scan(const Scene& scene, const Transformation& world_from_scanner, int count, double noise, Random random) {
  if (scene.sensor == Sensor::none) return scatter(scene, world_from_scanner, count, random);
  const double returned = static_cast<double>(cast(scene, world_from_scanner, probe_rays, 0.0, random).size());
  if (returned == 0.0) return {};
  return cast(scene, world_from_scanner, count * (probe_rays / returned), noise, random);
}

}  // namespace igsp::simulation
