#include <cmath>
#include <numbers>

#include "simulation/building.hpp"
#include "simulation/scene.hpp"
#include "simulation/vegetation.hpp"

namespace igsp::simulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double half_size = 36.0;  // of the square lawn [m]
constexpr double ground_cell = 0.5;

struct Wave {
  double x, y, phase, amplitude;  ///< wave vector [rad/m]

  double at(double px, double py) const { return amplitude * std::sin(x * px + y * py + phase); }
};

/// The lay of the land: gentle waves, and a winding path that is smooth across and a hand lower than the lawn.
struct Terrain {
  std::vector<Wave> hills, bumps;
  double path_offset, path_amplitude, path_frequency, path_phase, path_half_width;

  double path_y(double x) const { return path_offset + path_amplitude * std::sin(path_frequency * x + path_phase); }
  double path_slope(double x) const {
    return path_amplitude * path_frequency * std::cos(path_frequency * x + path_phase);
  }
  /// Distance across the path's edge, negative on the path; exact to first order, enough to keep things off it.
  double from_path(double x, double y) const {
    return std::abs(y - path_y(x)) / std::hypot(1.0, path_slope(x)) - path_half_width;
  }
  double height(double x, double y) const {
    double z = 0.0, rough = 0.0;
    for (const Wave& wave : hills) z += wave.at(x, y);
    for (const Wave& wave : bumps) rough += wave.at(x, y);
    const double lawn = 1.0 / (1.0 + std::exp(-8.0 * from_path(x, y)));
    return z + lawn * (rough + 0.06);
  }
};

std::vector<Wave> make_waves(int count, double shortest, double longest, double amplitude, Random& random) {
  std::vector<Wave> waves;
  for (int i = 0; i < count; ++i) {
    const double frequency = 2.0 * std::numbers::pi / random.uniform(shortest, longest), azimuth = random.angle();
    const double phase = random.angle(), size = amplitude * random.uniform(0.5, 1.0);
    waves.push_back({frequency * std::cos(azimuth), frequency * std::sin(azimuth), phase, size});
  }
  return waves;
}

Terrain make_terrain(Random& random) {
  Terrain terrain;
  terrain.hills = make_waves(4, 14.0, 45.0, random.uniform(0.08, 0.35), random);
  terrain.bumps = make_waves(8, 1.2, 4.0, 0.02, random);
  terrain.path_offset = random.uniform(-8.0, 6.0);
  terrain.path_amplitude = random.uniform(1.0, 6.0);
  terrain.path_frequency = random.uniform(0.06, 0.16);
  terrain.path_phase = random.angle();
  terrain.path_half_width = random.uniform(1.1, 1.9);
  return terrain;
}

void add_ground(Primitives& surfaces, const Terrain& terrain) {
  const int cells = static_cast<int>(2.0 * half_size / ground_cell);
  const auto corner = [&](int i, int j) {
    const double x = -half_size + i * ground_cell, y = -half_size + j * ground_cell;
    return Vector3d{x, y, terrain.height(x, y)};
  };
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const Vector3d a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
      surfaces.push_back(Triangle{a, b - a, c - a});
      surfaces.push_back(Triangle{a, c - a, d - a});
    }
  }
}

void add_kerbs(Primitives& surfaces, const Terrain& terrain) {
  for (double x = -half_size; x < half_size; x += 1.0) {
    const double slope = terrain.path_slope(x), length = std::hypot(1.0, slope);
    for (const double side : {-1.0, 1.0}) {
      const double out = side * (terrain.path_half_width + 0.06);
      const double px = x - out * slope / length, py = terrain.path_y(x) + out / length;
      const Isometry3d at = standing_at(px, py, terrain.height(px, py), std::atan(slope));
      surfaces.push_back(make_box(at, {0, 0, 0}, {length - 0.01, 0.12, 0.3}));
    }
  }
}

void add_bench(Primitives& surfaces, const Isometry3d& at, bool with_back) {
  for (const double y : {-0.16, 0.0, 0.16}) surfaces.push_back(make_box(at, {0, y, 0.45}, {1.8, 0.13, 0.04}));
  for (const double x : {-0.7, 0.7}) {
    surfaces.push_back(make_box(at, {x, 0, 0.2}, {0.08, 0.42, 0.48}));
    if (with_back) surfaces.push_back(make_box(at, {x, 0.24, 0.5}, {0.06, 0.05, 0.9}));
  }
  if (!with_back) return;
  for (const double z : {0.65, 0.85}) surfaces.push_back(make_box(at, {0, 0.2, z}, {1.8, 0.04, 0.14}));
}

void add_lamp_post(Primitives& surfaces, const Isometry3d& at, double height, bool with_arm) {
  const auto point = [&](double x, double z) { return Vector3d(at * Vector3d{x, 0, z}); };
  surfaces.push_back(make_frustum(point(0, -0.2), point(0, 0.5), 0.12, 0.09));
  surfaces.push_back(make_frustum(point(0, 0.5), point(0, height), 0.06, 0.04));
  if (with_arm) {
    surfaces.push_back(make_frustum(point(0, height), point(0.9, height + 0.2), 0.04, 0.03));
    surfaces.push_back(make_box(at, {1.1, 0, height + 0.18}, {0.6, 0.25, 0.12}));
  } else {
    surfaces.push_back(make_ellipsoid(point(0, height + 0.2), at.linear(), {0.22, 0.22, 0.25}));
  }
}

/// A statue on a pedestal.
void add_monument(Primitives& surfaces, const Isometry3d& at, Random& random) {
  const double side = random.uniform(0.8, 1.6), height = random.uniform(0.8, 1.8);
  surfaces.push_back(make_box(at, {0, 0, 0.05}, {side + 0.8, side + 0.8, 0.4}));
  surfaces.push_back(make_box(at, {0, 0, 0.5 * height}, {side, side, height}));
  surfaces.push_back(make_box(at, {0, 0, height}, {side + 0.2, side + 0.2, 0.12}));
  double z = height;
  for (const double radius : {0.45, 0.38, 0.2}) {
    const double x = 0.1 * random.normal(), y = 0.1 * random.normal(), tall = 1.4 * radius;
    const Eigen::Matrix3d turned = random.rotation();
    surfaces.push_back(make_ellipsoid(at * Vector3d{x, y, z + tall}, turned, {radius, 0.8 * radius, 1.3 * radius}));
    z += 1.8 * tall;
  }
}

void add_bin(Primitives& surfaces, const Isometry3d& at) {
  surfaces.push_back(make_frustum(at * Vector3d{0, 0, -0.1}, at * Vector3d{0, 0, 0.85}, 0.2, 0.26));
  surfaces.push_back(make_frustum(at * Vector3d{0, 0, 0.85}, at * Vector3d{0, 0, 0.95}, 0.28, 0.12));
}

/// Finds places on the lawn that keep their distance from the path, the building and each other.
class Lawn {
 public:
  Lawn(const Terrain& terrain, double end_y) : terrain_(terrain), end_y_(end_y) {}

  /// A place with `space` around it, at most `near_path` from the path; false when none was found.
  bool find(double space, double near_path, Random& random, Isometry3d& at) {
    for (int i = 0; i < 60; ++i) {
      const double x = random.uniform(-half_size + 1.0, half_size - 1.0), y = random.uniform(-half_size + 1.0, end_y_);
      const double from_path = terrain_.from_path(x, y);
      bool open = from_path > 0.6 && from_path < near_path;
      for (const auto& [other, taken] : taken_) open = open && (other - Vector2d{x, y}).norm() > space + taken;
      if (!open) continue;
      taken_.emplace_back(Vector2d{x, y}, space);
      at = standing_at(x, y, terrain_.height(x, y), random.angle());
      return true;
    }
    return false;
  }

 private:
  const Terrain& terrain_;
  double end_y_;
  std::vector<std::pair<Vector2d, double>> taken_;
};

/// Calls add(frame) for as many of `count` places as there are.
template <typename Add>
void scatter(Lawn& lawn, int count, double space, double near_path, Random& random, Add add) {
  Isometry3d at;
  for (int i = 0; i < count; ++i) {
    if (lawn.find(space, near_path, random, at)) add(at);
  }
}

void add_furniture(Primitives& surfaces, Lawn& lawn, Random& random) {
  scatter(lawn, random.integer(0, 1), 2.0, 30.0, random, [&](const auto& at) { add_monument(surfaces, at, random); });
  scatter(lawn, random.integer(4, 9), 0.9, 1.5, random,
          [&](const auto& at) { add_bench(surfaces, at, random.chance(0.7)); });
  const double height = random.uniform(3.5, 5.5);
  const bool with_arm = random.chance(0.5);
  scatter(lawn, random.integer(4, 9), 0.7, 1.2, random,
          [&](const auto& at) { add_lamp_post(surfaces, at, height, with_arm); });
  scatter(lawn, random.integer(2, 5), 0.5, 1.5, random, [&](const auto& at) { add_bin(surfaces, at); });
  scatter(lawn, random.integer(0, 8), 0.8, 30.0, random, [&](const auto& at) {
    const double size = random.uniform(0.25, 0.8), flat = random.uniform(0.5, 0.8), along = random.uniform(1.0, 1.6);
    surfaces.push_back(make_ellipsoid(at.translation(), at.linear(), {along * size, size, flat * size}));
  });
}

void add_plants(Primitives& surfaces, Lawn& lawn, Random& random) {
  const double conifers = random.uniform(0.0, 0.6), leafiness = random.chance(0.15) ? 0.1 : random.uniform(0.7, 1.4);
  const double space = random.uniform(0.9, 1.8);
  scatter(lawn, random.integer(20, 60), space, 60.0, random, [&](const auto& at) {
    if (random.chance(conifers)) {
      add_conifer(surfaces, at.translation(), random);
    } else {
      add_broadleaf(surfaces, at.translation(), leafiness, random);
    }
  });
  scatter(lawn, random.integer(5, 16), 0.8, 60.0, random,
          [&](const auto& at) { add_bush(surfaces, at.translation(), random.uniform(0.5, 1.3), random); });
}

}  // namespace

Scene build_park(Random& random) {
  const Terrain terrain = make_terrain(random);
  Primitives surfaces;
  add_ground(surfaces, terrain);
  add_kerbs(surfaces, terrain);
  const double length = random.uniform(22.0, 45.0), front_y = random.uniform(18.0, 27.0);
  const double left = random.uniform(-half_size, half_size - length), turn = random.uniform(-0.12, 0.12);
  const double level = terrain.height(left + 0.5 * length, front_y);
  add_building(surfaces, standing_at(left, front_y - 0.5 * length * turn, level, turn), length, random);
  Lawn lawn(terrain, front_y - 4.5);
  add_furniture(surfaces, lawn, random);
  add_plants(surfaces, lawn, random);

  Scene scene;
  scene.surfaces = BoundingVolumeHierarchy(surfaces);
  scene.station_area = Eigen::AlignedBox2d(Vector2d{-20.0, -20.0}, Vector2d{20.0, front_y - 5.0});
  scene.ground = [terrain](double x, double y) { return terrain.height(x, y); };
  scene.station_distance = random.uniform(10.0, 15.0);
  scene.min_visibility = 0.62;  // the lawn is scanned too thinly far away to count as overlap
  scene.max_visibility = 0.82;
  scene.max_range = 70.0;
  scene.min_clearance = 1.0;
  return scene;
}

}  // namespace igsp::simulation
