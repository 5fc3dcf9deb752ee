#include "registration/surface_contact.hpp"

#include <algorithm>
#include <cmath>

namespace igsp {
namespace {

constexpr std::size_t max_places = 1500;
constexpr double max_tangential = 1.0;  // voxels: farther away lies beyond the rim
constexpr double max_normal = 6.0;      // voxels: farther away is another surface
constexpr double touching = 1.0;        // voxels: at a wrong pose of a like surface more lies just beyond
constexpr double on_surface = 1.5;      // voxels

}  // namespace

SurfaceContact surface_contact(const PreparedCloud& moved, const PreparedCloud& fixed,
                               const Transformation& fixed_from_moved) {
  const double v = fixed.features.voxel_size;
  const double reach = std::hypot(max_tangential, max_normal) * v;
  const std::size_t stride = std::max<std::size_t>(1, moved.features.points.size() / max_places);
  double touching_weight = 0, weight_sum = 0;
  std::size_t places = 0, met = 0, covered = 0;
  for (std::size_t i = 0; i < moved.features.points.size(); i += stride) {
    ++places;
    const Eigen::Vector3d p = fixed_from_moved * moved.features.points[i];
    const std::int64_t j = fixed.grid.nearest(p.cast<float>(), static_cast<float>(reach));
    if (j < 0) continue;
    const Eigen::Vector3d difference = p - fixed.features.points[j];
    const double normal = std::abs(fixed.features.normals[j].dot(difference));
    const double tangential = std::sqrt(std::max(0.0, difference.squaredNorm() - normal * normal));
    if (tangential >= max_tangential * v || normal >= max_normal * v) continue;
    ++met;
    const double weight = 0.002 + std::min<double>(moved.features.curvature[i], 0.05);
    weight_sum += weight;
    if (normal < touching * v) touching_weight += weight;
    covered += normal < on_surface * v;
  }
  SurfaceContact contact;
  // Two pseudo-observations of each kind: few places prove little.
  const double n = static_cast<double>(met);
  contact.share = ((weight_sum > 0 ? touching_weight / weight_sum : 0.0) * n + 2) / (n + 4);
  if (places > 0) contact.overlap = static_cast<double>(covered) / static_cast<double>(places);
  return contact;
}

}  // namespace igsp
