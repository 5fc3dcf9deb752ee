#include "simulation/primitives.hpp"

#include <cmath>
#include <limits>

namespace igsp::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double start = 1e-9;  // a crossing at the origin itself is not ahead of it

/// Solves origin + t direction = corner + a u + b v by Cramer's rule; `inside(a, b)` bounds the patch.
template <typename Inside>
double cross_patch(const Vector3d& corner, const Vector3d& u, const Vector3d& v, const Ray& ray, Inside inside) {
  const Vector3d p = ray.direction.cross(v);
  const double determinant = u.dot(p);
  if (determinant == 0.0) return infinity;
  const Vector3d s = ray.origin - corner;
  const double a = s.dot(p) / determinant;
  if (a < 0.0 || a > 1.0) return infinity;
  const Vector3d q = s.cross(u);
  const double b = ray.direction.dot(q) / determinant;
  if (!inside(a, b)) return infinity;
  const double t = v.dot(q) / determinant;
  return t > start ? t : infinity;
}

double crossing(const Triangle& triangle, const Ray& ray) {
  return cross_patch(triangle.corner, triangle.u, triangle.v, ray,
                     [](double a, double b) { return b >= 0.0 && a + b <= 1.0; });
}

double crossing(const Parallelogram& patch, const Ray& ray) {
  return cross_patch(patch.corner, patch.u, patch.v, ray, [](double, double b) { return b >= 0.0 && b <= 1.0; });
}

double crossing(const Box& box, const Ray& ray) {
  const Vector3d o = box.unit_from_world * (ray.origin - box.centre), d = box.unit_from_world * ray.direction;
  double enter = -infinity, leave = infinity;
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0.0) {
      if (std::abs(o[i]) > 1.0) return infinity;
      continue;
    }
    const double a = (-1.0 - o[i]) / d[i], b = (1.0 - o[i]) / d[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > leave) return infinity;
  return enter > start ? enter : (leave > start ? leave : infinity);
}

double crossing(const Ellipsoid& ellipsoid, const Ray& ray) {
  const Vector3d o = ellipsoid.unit_from_world * (ray.origin - ellipsoid.centre);
  const Vector3d d = ellipsoid.unit_from_world * ray.direction;
  const double a = d.squaredNorm(), b = o.dot(d), discriminant = b * b - a * (o.squaredNorm() - 1.0);
  if (discriminant < 0.0) return infinity;
  const double root = std::sqrt(discriminant), near = (-b - root) / a, far = (-b + root) / a;
  return near > start ? near : (far > start ? far : infinity);
}

double crossing(const Frustum& f, const Ray& ray) {
  // Along the axis: s(t) = s0 + t sd. Side: |w + t v|^2 = (r0 + slope s(t))^2, w and v perpendicular to the axis.
  const Vector3d from_base = ray.origin - f.base;
  const double s0 = from_base.dot(f.axis), sd = ray.direction.dot(f.axis);
  const Vector3d w = from_base - s0 * f.axis, v = ray.direction - sd * f.axis;
  const double slope = (f.top_radius - f.base_radius) / f.length, radius = f.base_radius + slope * s0;
  double nearest = infinity;
  const auto keep = [&](double t) {
    if (t > start && t < nearest) nearest = t;
  };
  const double a = v.squaredNorm() - slope * slope * sd * sd, b = w.dot(v) - slope * sd * radius;
  const double c = w.squaredNorm() - radius * radius, discriminant = b * b - a * c;
  if (std::abs(a) > 1e-12 && discriminant >= 0.0) {
    const double root = std::sqrt(discriminant);
    for (const double t : {(-b - root) / a, (-b + root) / a}) {
      const double s = s0 + t * sd;
      if (s >= 0.0 && s <= f.length) keep(t);  // both radii are >= 0, so the mirrored cone lies outside
    }
  }
  if (sd != 0.0) {
    const double to_base = -s0 / sd, to_top = (f.length - s0) / sd;
    if ((w + to_base * v).squaredNorm() <= f.base_radius * f.base_radius) keep(to_base);
    if ((w + to_top * v).squaredNorm() <= f.top_radius * f.top_radius) keep(to_top);
  }
  return nearest;
}

Vector3d normal(const Triangle& triangle, const Vector3d&) {
  return triangle.u.cross(triangle.v).normalized();
}
Vector3d normal(const Parallelogram& patch, const Vector3d&) {
  return patch.u.cross(patch.v).normalized();
}

Vector3d normal(const Box& box, const Vector3d& point) {
  int face = 0;
  (box.unit_from_world * (point - box.centre)).cwiseAbs().maxCoeff(&face);
  return box.unit_from_world.row(face).transpose().normalized();
}

Vector3d normal(const Ellipsoid& ellipsoid, const Vector3d& point) {
  const Vector3d unit = ellipsoid.unit_from_world * (point - ellipsoid.centre);
  return (ellipsoid.unit_from_world.transpose() * unit).normalized();
}

Vector3d normal(const Frustum& f, const Vector3d& point) {
  const double s = (point - f.base).dot(f.axis), slope = (f.top_radius - f.base_radius) / f.length;
  const Vector3d outward = point - f.base - s * f.axis;
  const double inside = f.base_radius + slope * s - outward.norm();
  if (inside > 1e-6 * f.length) return f.axis;  // a cap
  return (outward.normalized() - slope * f.axis).normalized();
}

template <typename Patch>
Eigen::AlignedBox3d patch_bounds(const Patch& patch) {
  Eigen::AlignedBox3d box(patch.corner);
  return box.extend(patch.corner + patch.u).extend(patch.corner + patch.v);
}

Eigen::AlignedBox3d box_of(const Triangle& triangle) {
  return patch_bounds(triangle);
}
Eigen::AlignedBox3d box_of(const Parallelogram& patch) {
  return patch_bounds(patch).extend(patch.corner + patch.u + patch.v);
}

Eigen::AlignedBox3d box_of(const Box& box) {
  const Vector3d reach = box.unit_from_world.inverse().cwiseAbs().rowwise().sum();
  return {box.centre - reach, box.centre + reach};
}

Eigen::AlignedBox3d box_of(const Ellipsoid& ellipsoid) {
  const Vector3d reach = ellipsoid.unit_from_world.inverse().rowwise().norm();
  return {ellipsoid.centre - reach, ellipsoid.centre + reach};
}

Eigen::AlignedBox3d box_of(const Frustum& f) {
  const Vector3d across = (Vector3d::Ones() - f.axis.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  const Vector3d top = f.base + f.length * f.axis;
  Eigen::AlignedBox3d box(f.base - f.base_radius * across, f.base + f.base_radius * across);
  return box.extend(top - f.top_radius * across).extend(top + f.top_radius * across);
}

}  // namespace

double first_crossing(const Primitive& primitive, const Ray& ray) {
  return std::visit([&](const auto& shape) { return crossing(shape, ray); }, primitive);
}

Vector3d normal_at(const Primitive& primitive, const Vector3d& point) {
  return std::visit([&](const auto& shape) { return normal(shape, point); }, primitive);
}

Eigen::AlignedBox3d bounds(const Primitive& primitive) {
  return std::visit([](const auto& shape) { return box_of(shape); }, primitive);
}

Eigen::Isometry3d standing_at(double x, double y, double z, double yaw) {
  Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
  at.linear() = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
  at.translation() = Vector3d{x, y, z};
  return at;
}

Box make_box(const Eigen::Isometry3d& at, const Vector3d& centre, const Vector3d& size) {
  return {at * centre, (2.0 * size.cwiseInverse()).asDiagonal() * at.linear().transpose()};
}

Ellipsoid make_ellipsoid(const Vector3d& centre, const Matrix3d& rotation, const Vector3d& radii) {
  return {centre, radii.cwiseInverse().asDiagonal() * rotation.transpose()};
}

Frustum make_frustum(const Vector3d& from, const Vector3d& to, double from_radius, double to_radius) {
  return {from, (to - from).normalized(), (to - from).norm(), from_radius, to_radius};
}

Parallelogram make_parallelogram(const Eigen::Isometry3d& at, const Vector3d& corner, const Vector3d& u,
                                 const Vector3d& v) {
  return {at * corner, at.linear() * u, at.linear() * v};
}

}  // namespace igsp::simulation
