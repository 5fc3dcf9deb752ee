#include "registration/surface_contact.hpp"

#include <algorithm>
#include <cmath>

#include "registration/facing.hpp"

namespace igsp {
namespace {

constexpr std::size_t max_places = 1500;
constexpr double max_tangential = 1.0;  // voxels: farther away lies beyond the rim
constexpr double max_normal = 6.0;      // voxels: farther away is another surface
constexpr double touching = 1.0;        // voxels: at a wrong pose of a like surface more lies just beyond
constexpr double on_surface = 1.5;      // voxels
constexpr float scattered = 0.1f;       // surface variation of foliage, which has no sides

// visit(i, j, distance along the normal) for the places i of `moved`, evenly strided, that meet the surface of `fixed`
// at j; how many were tried. `normal_of(j)`: of the points of `fixed`.
template <typename NormalOf, typename Visit>
std::size_t visit_places(PointView moved, PointView fixed, const PointGrid& grid, double v,
                         const Transformation& fixed_from_moved, const NormalOf& normal_of, const Visit& visit) {
  const double reach = std::hypot(max_tangential, max_normal) * v;
  const std::size_t stride = std::max<std::size_t>(1, moved.size() / max_places);
  std::size_t places = 0;
  for (std::size_t i = 0; i < moved.size(); i += stride) {
    ++places;
    const Eigen::Vector3d p = fixed_from_moved * moved[i];
    const std::int64_t j = grid.nearest(p.cast<float>(), static_cast<float>(reach));
    if (j < 0) continue;
    const Eigen::Vector3d difference = p - fixed[j];
    const double normal = std::abs(normal_of(j).dot(difference));
    const double tangential = std::sqrt(std::max(0.0, difference.squaredNorm() - normal * normal));
    if (tangential < max_tangential * v && normal < max_normal * v) visit(i, j, normal);
  }
  return places;
}

double share_of(std::size_t covered, std::size_t places) {
  return places > 0 ? static_cast<double>(covered) / static_cast<double>(places) : 0.0;
}

}  // namespace

double SurfaceOverlap::share() const {
  return share_of(covered, places);
}

SurfaceContact surface_contact(const PreparedCloud& moved, const PreparedCloud& fixed,
                               const Transformation& fixed_from_moved) {
  const double v = fixed.features.voxel_size;
  double touching_weight = 0, weight_sum = 0;
  std::size_t met = 0, covered = 0;
  const auto normal_of = [&](std::size_t j) -> const Eigen::Vector3d& { return fixed.features.normals[j]; };
  const auto are_of_two_sides = [&](std::size_t i, std::size_t j, double normal) {
    const Features &a = moved.features, &b = fixed.features;
    if (normal < touching * v && std::max(a.curvature[i], b.curvature[j]) > scattered) return false;
    return are_two_sides({a.points[i], a.normals[i], moved.viewpoints.of(i)},
                         {b.points[j], b.normals[j], fixed.viewpoints.of(j)},
                         (fixed_from_moved.linear() * a.normals[i]).dot(b.normals[j]));
  };
  const auto count = [&](std::size_t i, std::size_t j, double normal) {
    if (are_of_two_sides(i, j, normal)) return;
    ++met;
    const double weight = 0.002 + std::min<double>(moved.features.curvature[i], 0.05);
    weight_sum += weight;
    if (normal < touching * v) touching_weight += weight;
    covered += normal < on_surface * v;
  };
  const std::size_t places =
      visit_places(moved.features.points, fixed.features.points, fixed.grid, v, fixed_from_moved, normal_of, count);
  SurfaceContact contact;
  // Two pseudo-observations of each kind: few places prove little.
  const double n = static_cast<double>(met);
  contact.share = ((weight_sum > 0 ? touching_weight / weight_sum : 0.0) * n + 2) / (n + 4);
  contact.overlap = share_of(covered, places);
  return contact;
}

SurfaceOverlap overlap_of(PointView moved, const Surface& fixed, double voxel_size,
                          const Transformation& fixed_from_moved) {
  SurfaceOverlap overlap;
  overlap.places = visit_places(
      moved, fixed.points(), fixed.grid(), voxel_size, fixed_from_moved, [&](std::size_t j) { return fixed.normal(j); },
      [&](std::size_t, std::size_t, double normal) {
        ++overlap.met;
        overlap.covered += normal < on_surface * voxel_size;
      });
  return overlap;
}

}  // namespace igsp
