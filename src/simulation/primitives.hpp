#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <variant>
#include <vector>

namespace igsp::simulation {

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit
};

struct Triangle {
  Eigen::Vector3d corner, u, v;  ///< corner and the two edges from it
};

struct Parallelogram {
  Eigen::Vector3d corner, u, v;
};

/// The cube [-1, 1]^3 under an invertible affine map.
struct Box {
  Eigen::Vector3d centre;
  Eigen::Matrix3d unit_from_world;
};

/// The unit sphere under an invertible affine map.
struct Ellipsoid {
  Eigen::Vector3d centre;
  Eigen::Matrix3d unit_from_world;
};

/// A closed cone frustum; a cylinder when the radii are equal.
struct Frustum {
  Eigen::Vector3d base, axis;  ///< axis unit
  double length, base_radius, top_radius;
};

using Primitive = std::variant<Triangle, Parallelogram, Box, Ellipsoid, Frustum>;
using Primitives = std::vector<Primitive>;

/// Distance from the ray's origin to its first crossing of the surface; infinity when there is none.
double first_crossing(const Primitive& primitive, const Ray& ray);

/// Unit normal at a point of the surface, either side.
Eigen::Vector3d normal_at(const Primitive& primitive, const Eigen::Vector3d& point);

Eigen::AlignedBox3d bounds(const Primitive& primitive);

/// A frame that stands on (x, y, z), turned by `yaw` radians about the vertical.
Eigen::Isometry3d standing_at(double x, double y, double z, double yaw);

/// Box with its middle at `centre` of the frame `at` and full side lengths `size`.
Box make_box(const Eigen::Isometry3d& at, const Eigen::Vector3d& centre, const Eigen::Vector3d& size);
Ellipsoid make_ellipsoid(const Eigen::Vector3d& centre, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& radii);
Frustum make_frustum(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double from_radius, double to_radius);
/// Axis-aligned rectangle or any other parallelogram in the frame `at`.
Parallelogram make_parallelogram(const Eigen::Isometry3d& at, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                                 const Eigen::Vector3d& v);

}  // namespace igsp::simulation
