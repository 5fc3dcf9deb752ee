#include "spatial/direction_image.hpp"

#include <algorithm>
#include <cmath>

namespace igsp {
namespace {

constexpr int finer_far_away = 3;  // the whole cloud in one image, which is as wide as a right angle about a scanner
constexpr double surrounds = 1.5;  // radii: nearer, an image of the whole would be wider than a face of the cube

std::uint32_t cell_along(double position, double half_width, std::uint32_t size) {
  const double scaled = (position / half_width + 1) * 0.5 * size;
  return static_cast<std::uint32_t>(std::clamp(scaled, 0.0, static_cast<double>(size) - 1));
}

}  // namespace

Eigen::Vector3d not_too_far(const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& centre, double size) {
  const Eigen::Vector3d offset = viewpoint - centre;
  const double distance = offset.stableNorm(), limit = 1e6 * size;
  return distance > limit ? Eigen::Vector3d(centre + offset * (limit / distance)) : viewpoint;
}

DirectionImage::DirectionImage(const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& centre, double radius,
                               int cells_per_face)
    : viewpoint_(viewpoint),
      far_((centre - viewpoint).norm() > surrounds * radius),
      size_(static_cast<std::uint32_t>(far_ ? finer_far_away * cells_per_face : cells_per_face)) {
  if (!far_) return;
  const double distance = (centre - viewpoint).norm();
  half_width_ = radius / std::sqrt((distance - radius) * (distance + radius));
  const Eigen::Vector3d depth = (centre - viewpoint) / distance, across = depth.unitOrthogonal();
  image_from_cloud_.row(0) = across;
  image_from_cloud_.row(1) = depth.cross(across);
  image_from_cloud_.row(2) = depth;
}

std::uint32_t DirectionImage::cell_of(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d ray = image_from_cloud_ * (point - viewpoint_);
  Eigen::Index axis = 2;
  if (!far_) ray.cwiseAbs().maxCoeff(&axis);
  const double depth = ray[axis];
  if (far_ ? !(depth > 0) : depth == 0) return nowhere;
  const double u = ray[(axis + 1) % 3] / std::abs(depth), v = ray[(axis + 2) % 3] / std::abs(depth);
  if (std::max(std::abs(u), std::abs(v)) > half_width_) return nowhere;
  const auto face = far_ ? 0u : static_cast<std::uint32_t>(2 * axis + (depth < 0 ? 1 : 0));
  return (face * size_ + cell_along(u, half_width_, size_)) * size_ + cell_along(v, half_width_, size_);
}

}  // namespace igsp
