#include "simulation/vegetation.hpp"

#include <numbers>

namespace igsp::simulation {
namespace {

using Eigen::Vector3d;

/// A chain of frusta from `from` along `direction`, bending a little at every joint; its joints, the start included.
std::vector<Vector3d> add_limb(Primitives& surfaces, const Vector3d& from, Vector3d direction, double length,
                               double from_radius, double to_radius, int segments, double bend, Random& random) {
  std::vector<Vector3d> joints{from};
  for (int i = 0; i < segments; ++i) {
    const double r0 = from_radius + (to_radius - from_radius) * i / segments;
    const double r1 = from_radius + (to_radius - from_radius) * (i + 1) / segments;
    const Vector3d next = joints.back() + length / segments * direction;
    surfaces.push_back(make_frustum(joints.back(), next, r0, r1));
    joints.push_back(next);
    direction = (direction + bend * random.normal_vector()).normalized();
  }
  return joints;
}

/// The point at `share` of a polyline with equal segments.
Vector3d along(const std::vector<Vector3d>& joints, double share) {
  const double position = share * static_cast<double>(joints.size() - 1);
  const std::size_t i = std::min(joints.size() - 2, static_cast<std::size_t>(position));
  return joints[i] + (position - static_cast<double>(i)) * (joints[i + 1] - joints[i]);
}

Vector3d sideways(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

}  // namespace

void add_clump(Primitives& surfaces, const Vector3d& centre, double radius, int leaves, double size, Random& random) {
  for (int i = 0; i < leaves; ++i) {
    const Vector3d position = centre + 0.5 * radius * random.normal_vector();
    const Vector3d along_leaf = random.direction();
    const Vector3d across = along_leaf.cross(random.direction()).normalized();
    const double length = size * random.uniform(0.6, 1.4);
    surfaces.push_back(Parallelogram{position, length * along_leaf, 0.6 * length * across});
  }
}

void add_broadleaf(Primitives& surfaces, const Vector3d& foot, double leafiness, Random& random) {
  const double height = random.uniform(5.0, 13.0), radius = height * random.uniform(0.015, 0.03);
  const double spread = random.uniform(0.22, 0.38), clear_trunk = random.uniform(0.25, 0.45);
  const Vector3d lean = (Vector3d::UnitZ() + 0.06 * random.normal_vector()).normalized();
  const auto trunk = add_limb(surfaces, foot - 0.3 * lean, lean, 0.8 * height, radius, 0.35 * radius, 5, 0.05, random);
  const int branches = random.integer(6, 11);
  double azimuth = random.angle();
  for (int i = 0; i < branches; ++i) {
    azimuth += 2.4 + 0.4 * random.normal();  // about the golden angle: branches avoid the shade of each other
    const double share = clear_trunk + (1.0 - clear_trunk) * (i + random.uniform()) / branches;
    const double elevation = random.uniform(0.2, 0.6) + 0.5 * share, thickness = radius * (0.45 - 0.25 * share);
    const double length = height * spread * (1.25 - 0.7 * share) * random.uniform(0.75, 1.2);
    const auto branch = add_limb(surfaces, along(trunk, share), sideways(azimuth, elevation), length, thickness,
                                 0.3 * thickness, 3, 0.15, random);
    for (const double fork : {0.5, 0.75, 1.0}) {
      const double turn = azimuth + random.uniform(-1.2, 1.2), rise = random.uniform(0.0, 0.9);
      const auto twig = add_limb(surfaces, along(branch, fork), sideways(turn, rise), 0.4 * length, 0.35 * thickness,
                                 0.1 * thickness, 2, 0.25, random);
      const int leaves = static_cast<int>(leafiness * random.uniform(20.0, 50.0));
      add_clump(surfaces, twig.back(), 0.35 * length + 0.25, leaves, 0.16, random);
    }
  }
}

void add_conifer(Primitives& surfaces, const Vector3d& foot, Random& random) {
  const double height = random.uniform(6.0, 14.0), radius = height * random.uniform(0.014, 0.022);
  const double skirt = height * random.uniform(0.16, 0.26), lowest = random.uniform(0.08, 0.25);
  const Vector3d lean = (Vector3d::UnitZ() + 0.02 * random.normal_vector()).normalized();
  const auto trunk = add_limb(surfaces, foot - 0.3 * lean, lean, height, radius, 0.1 * radius, 4, 0.01, random);
  for (double share = lowest; share < 0.97; share += random.uniform(0.05, 0.08)) {
    const int branches = random.integer(5, 8);
    const double reach = skirt * (1.0 - share) / (1.0 - lowest) + 0.2, offset = random.angle();
    for (int i = 0; i < branches; ++i) {
      const double azimuth = offset + 2.0 * std::numbers::pi * i / branches + 0.15 * random.normal();
      const double droop = random.uniform(-0.35, 0.05), length = reach * random.uniform(0.8, 1.1);
      const auto branch = add_limb(surfaces, along(trunk, share), sideways(azimuth, droop), length, 0.15 * radius,
                                   0.05 * radius, 2, 0.08, random);
      for (double out = 0.35; out < 1.01; out += 0.22) {
        add_clump(surfaces, along(branch, std::min(out, 1.0)), 0.12 * reach + 0.1, 5, 0.16, random);
      }
    }
  }
}

void add_bush(Primitives& surfaces, const Vector3d& foot, double radius, Random& random) {
  const int stems = random.integer(6, 12);
  for (int i = 0; i < stems; ++i) {
    const double rise = random.uniform(0.3, 1.4);  // not among the arguments below, whose order is the compiler's
    const Vector3d direction = sideways(random.angle(), rise);
    const auto stem = add_limb(surfaces, foot, direction, radius, 0.02, 0.008, 2, 0.15, random);
    add_clump(surfaces, stem.back(), 0.5 * radius, random.integer(40, 80), 0.08, random);
  }
}

}  // namespace igsp::simulation
