// Scenes without a single right answer: what a registration must refuse or call ambiguous.
#include "simulation/scene.hpp"

namespace igsp::simulation {
namespace {

using Eigen::Vector3d;

constexpr double endless = 400.0;  // far beyond the scanner's range from anywhere in the station area

/// Six sides of a hollow box that stands on z = 0, centred on the origin.
Primitives hollow_box(double length, double width, double height) {
  const Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
  const Vector3d x{length, 0, 0}, y{0, width, 0}, z{0, 0, height};
  const Vector3d low{-0.5 * length, -0.5 * width, 0}, high{0.5 * length, 0.5 * width, height};
  return {make_parallelogram(at, low, x, y),    make_parallelogram(at, low, x, z),
          make_parallelogram(at, low, y, z),    make_parallelogram(at, high, -x, -y),
          make_parallelogram(at, high, -x, -z), make_parallelogram(at, high, -y, -z)};
}

Scene terrestrial(const Primitives& surfaces, double half_x, double half_y) {
  Scene scene;
  scene.surfaces = BoundingVolumeHierarchy(surfaces);
  scene.station_area = Eigen::AlignedBox2d(Eigen::Vector2d{-half_x, -half_y}, Eigen::Vector2d{half_x, half_y});
  return scene;
}

Scene on_the_table(const Primitive& body, double radius) {
  Scene scene;
  scene.surfaces = BoundingVolumeHierarchy({body});
  scene.sensor = Sensor::range_camera;
  scene.radius = radius;
  scene.noise = 1e-4;
  scene.station_distance = 3.83 * radius;  // 45 degrees apart
  return scene;
}

Scene corridor(const Primitives& surfaces, double width) {
  Scene scene = terrestrial(surfaces, 20.0, 0.5 * width);
  scene.max_range = 40.0;
  scene.station_distance = 4.0;
  return scene;
}

}  // namespace

Scene build_plane(Random& random) {
  const Eigen::Isometry3d at = standing_at(0, 0, 0, random.angle());
  return terrestrial({make_parallelogram(at, {-endless / 2, -endless / 2, 0}, {endless, 0, 0}, {0, endless, 0})}, 20.0,
                     20.0);
}

Scene build_sphere(Random& random) {
  const double radius = random.uniform(0.08, 0.12);
  const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  return on_the_table(make_ellipsoid(Vector3d::Zero(), upright, Vector3d::Constant(radius)), radius);
}

Scene build_cylinder(Random& random) {
  const double half = random.uniform(0.07, 0.12), radius = random.uniform(0.03, 0.06);
  return on_the_table(make_frustum({0, 0, -half}, {0, 0, half}, radius, radius), std::hypot(half, radius));
}

Scene build_corridor(Random& random) {
  const double width = random.uniform(2.0, 3.0), height = random.uniform(2.4, 3.0);
  return corridor(hollow_box(endless, width, height), width);
}

Scene build_square_room(Random& random) {
  const double side = random.uniform(5.0, 8.0);
  Scene scene = terrestrial(hollow_box(side, side, random.uniform(2.4, 3.2)), 0.5 * side, 0.5 * side);
  scene.station_distance = 2.0;
  return scene;
}

Scene build_repetitive_corridor(Random& random) {
  const double width = random.uniform(2.0, 3.0), height = random.uniform(2.5, 3.0), period = random.uniform(2.4, 4.0);
  Primitives surfaces = hollow_box(endless, width, height);
  for (double x = 0.0; x < 0.25 * endless; x += period) {
    for (const double along : {x, -x - period}) {
      for (const double side : {-1.0, 1.0}) {
        // Frame, leaf a little inside it, handle; the same on both walls.
        const Eigen::Isometry3d at = standing_at(along, side * 0.5 * width, 0.0, side > 0 ? 0.0 : std::numbers::pi);
        surfaces.push_back(make_box(at, {-0.5, 0, 1.05}, {0.08, 0.12, 2.1}));
        surfaces.push_back(make_box(at, {0.5, 0, 1.05}, {0.08, 0.12, 2.1}));
        surfaces.push_back(make_box(at, {0, 0, 2.14}, {1.08, 0.12, 0.08}));
        surfaces.push_back(make_box(at, {0, 0, 1.05}, {0.92, 0.04, 2.1}));
        surfaces.push_back(make_box(at, {0.38, -0.06, 1.05}, {0.12, 0.08, 0.03}));
      }
      const Eigen::Isometry3d above = standing_at(along, 0, height, 0);
      surfaces.push_back(make_box(above, {0, 0, -0.04}, {1.2, 0.25, 0.08}));
    }
  }
  return corridor(surfaces, width);
}

Scene build_noise(Random& random) {
  Scene scene;
  scene.sensor = Sensor::none;
  scene.radius = random.uniform(4.0, 8.0);
  scene.station_distance = 0.5 * scene.radius;
  return scene;
}

}  // namespace igsp::simulation
