#include "simulation/scene.hpp"
#include "simulation/surface_net.hpp"

namespace igsp::simulation {
namespace {

using Eigen::Vector3d;

constexpr double iso_level = 0.25;

/// Adds (1 - |M (p - c)|^2)^3 inside the unit sphere of M: a smooth bump of value 1 with compact support.
void add_blob(Field& field, const Vector3d& centre, const Eigen::Matrix3d& rotation, const Vector3d& radii) {
  const Ellipsoid support = make_ellipsoid(centre, rotation, radii);
  field.visit(bounds(support), [&](const Vector3d& p, float& value) {
    const double d2 = (support.unit_from_world * (p - centre)).squaredNorm();
    if (d2 < 1.0) value += static_cast<float>((1.0 - d2) * (1.0 - d2) * (1.0 - d2));
  });
}

/// A limb: blobs along a curve, thinner towards its end, which may swell into a hand or a head.
void add_limb(Field& field, Vector3d at, Vector3d direction, double radius, Random& random) {
  const int steps = random.integer(4, 9);
  const double taper = random.uniform(0.85, 0.97), swell = random.chance(0.4) ? random.uniform(1.2, 1.7) : 1.0;
  for (int i = 0; i < steps; ++i) {
    const double end = i + 1 == steps ? swell : 1.0;
    const Vector3d stretch = Vector3d::Ones() + 0.15 * random.normal_vector().cwiseMax(-2.0).cwiseMin(2.0);
    add_blob(field, at, random.rotation(), end * radius * stretch);
    direction = (direction + 0.25 * random.normal_vector()).normalized();
    at += 0.5 * radius * direction;
    radius *= taper;
  }
}

/// Where a walk from inside the body leaves it.
Vector3d surface_along(const Field& field, Vector3d at, const Vector3d& direction) {
  while (field.box().contains(at) && field.value(field.nearest(at)) > iso_level) at += 0.02 * direction;
  return at;
}

/// Folds and chisel marks: waves in the field, which shift the surface by a little; many, so that no pattern repeats.
void add_texture(Field& field, Random& random) {
  struct Wave {
    Vector3d frequency;
    double phase, depth;
  };
  std::vector<Wave> waves;
  for (int i = 0; i < 16; ++i) {
    const double frequency = random.uniform(8.0, 40.0), phase = random.angle(), depth = random.uniform(0.003, 0.011);
    waves.push_back({frequency * random.direction(), phase, depth});
  }
  field.visit(field.box(), [&](const Vector3d& p, float& value) {
    if (value < 0.05f || value > 0.7f) return;  // the surface is nowhere near
    double sum = 0.0;
    for (const Wave& wave : waves) sum += wave.depth * std::sin(wave.frequency.dot(p) + wave.phase);
    value += static_cast<float>(sum);
  });
}

/// In units of about the body's radius.
Field make_body(Random& random) {
  Field field(Eigen::AlignedBox3d(Vector3d::Constant(-2.6), Vector3d::Constant(2.6)), 150);
  Points body;
  for (int i = random.integer(2, 4); i > 0; --i) {
    body.push_back(0.35 * random.normal_vector());
    const double a = random.uniform(0.9, 1.4), b = random.uniform(0.7, 1.2), c = random.uniform(0.6, 1.0);
    add_blob(field, body.back(), random.rotation(), Vector3d{a, b, c});
  }
  for (int i = random.integer(3, 6); i > 0; --i) {
    const Vector3d from = body[random.integer(0, static_cast<int>(body.size()) - 1)], direction = random.direction();
    add_limb(field, from + 0.5 * direction, direction, random.uniform(0.3, 0.55), random);
  }
  for (int i = random.integer(4, 20); i > 0; --i) {  // warts and ears
    const Vector3d at = surface_along(field, body[0], random.direction());
    const double a = random.uniform(0.12, 0.3), b = random.uniform(0.12, 0.4);
    add_blob(field, at, random.rotation(), Vector3d{a, a, b});
  }
  add_texture(field, random);
  return field;
}

}  // namespace

Scene build_object(Random& random) {
  std::vector<Triangle> triangles = surface_net(make_body(random), iso_level);
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : triangles) box.extend(bounds(triangle));
  const double size = random.uniform(0.17, 0.23), scale = size / box.sizes().maxCoeff();
  Scene scene;
  Primitives surfaces;
  for (const Triangle& triangle : triangles) {
    const Vector3d corner = scale * (triangle.corner - box.center());
    scene.radius = std::max(scene.radius, corner.norm());
    surfaces.push_back(Triangle{corner, scale * triangle.u, scale * triangle.v});
  }
  scene.surfaces = BoundingVolumeHierarchy(surfaces);
  scene.sensor = Sensor::range_camera;
  scene.noise = 1e-4;
  scene.station_distance = 3.83 * scene.radius;  // 45 degrees apart
  return scene;
}

}  // namespace igsp::simulation
