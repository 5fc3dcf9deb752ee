#include "registration/free_space.hpp"

#include <algorithm>

namespace igsp {
namespace {

constexpr std::size_t max_looks = 1000;

// Surfaces end somewhere between two points and may be met at a grazing angle: what lies on one that was seen, or just
// beyond its rim, does not contradict, however it is seen.
constexpr double on_surface = 3.0;  // voxels

// Points in view that agree, added to those that are there: few prove little.
constexpr double assumed_agreeing = 20;

}  // namespace

double FreeSpaceViolation::share() const {
  return static_cast<double>(contradicting) / (static_cast<double>(in_view) + assumed_agreeing);
}

double FreeSpace::violation() const {
  return std::max(source ? source->share() : 0.0, target ? target->share() : 0.0);
}

std::optional<FreeSpaceViolation> free_space_violation(const PreparedCloud& moved, const PreparedCloud& fixed,
                                                       const Transformation& fixed_from_moved) {
  if (!fixed.range_image) return {};
  FreeSpaceViolation violation;
  const float reach = static_cast<float>(on_surface * fixed.features.voxel_size);
  const Points& points = moved.features.points;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / max_looks);
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Eigen::Vector3d point = fixed_from_moved * points[i];
    const RangeImage::Sight sight = fixed.range_image->look_at(point);
    if (sight == RangeImage::Sight::out_of_view) continue;
    ++violation.in_view;
    if (sight == RangeImage::Sight::possible) continue;
    if (fixed.grid.nearest(point.cast<float>(), reach) < 0) ++violation.contradicting;
  }
  return violation;
}

FreeSpace free_space(const PreparedCloud& source, const PreparedCloud& target,
                     const Transformation& target_from_source) {
  return {free_space_violation(source, target, target_from_source),
          free_space_violation(target, source, target_from_source.inverse())};
}

}  // namespace igsp
