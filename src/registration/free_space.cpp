#include "registration/free_space.hpp"

#include <algorithm>
#include <cmath>

namespace igsp {
namespace {

// Surfaces end somewhere between two points and may be met at a grazing angle: what lies on one that was seen, or just
// beyond its rim, does not contradict, however it is seen.
constexpr double on_surface = 3.0;  // voxels

// People walk, leaves move, rims are met at a grazing angle: right poses of real scans are contradicted by so much,
// hardly one by more.
constexpr double tolerated = 0.035;
constexpr double decades_per_share = 20, most_decades_against = 2;  // beyond what is tolerated
constexpr double decades_for = 0.5;                                 // a direction, where nothing is contradicted
constexpr double convincing_view = 100;                             // points in view for half of that
// A wrong pose is not contradicted either where the voxels are as large as what is in the scene: none for the first
// number of voxels, all for the second.
constexpr double coarse_voxels = 1000, fine_voxels = 10000;

// Points in view that agree, added to those that are there: few prove little.
constexpr double assumed_agreeing = 20;

double confirmed_by(const std::optional<FreeSpaceViolation>& violation) {
  if (!violation) return 0;
  const double in_view = static_cast<double>(violation->in_view);
  return std::max(0.0, 1 - violation->share() / tolerated) * in_view / (in_view + convincing_view);
}

double resolution(const Features& source, const Features& target) {
  const double voxels =
      std::sqrt(static_cast<double>(source.points.size()) * static_cast<double>(target.points.size()));
  return std::clamp(std::log(voxels / coarse_voxels) / std::log(fine_voxels / coarse_voxels), 0.0, 1.0);
}

}  // namespace

double FreeSpaceViolation::share() const {
  return static_cast<double>(contradicting) / (static_cast<double>(in_view) + assumed_agreeing);
}

double FreeSpace::violation() const {
  return std::max(source ? source->share() : 0.0, target ? target->share() : 0.0);
}

ScannedSpace::ScannedSpace(const Features& features) : features_(features) {
  if (!features.viewpoint) return;
  seen_.emplace(PointGrid(features.points, on_surface * features.voxel_size),
                RangeImage(features.fine_points, *features.viewpoint, features.voxel_size));
}

std::optional<FreeSpaceViolation> ScannedSpace::violation_by(const ScannedSpace& moved,
                                                             const Transformation& this_from_moved,
                                                             std::size_t most_looks) const {
  if (!seen_) return {};
  FreeSpaceViolation violation;
  const Points& points = moved.features_.points;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / most_looks);
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Eigen::Vector3d point = this_from_moved * points[i];
    const auto [sight, growth] = seen_->image.look_at(point);
    if (sight == RangeImage::Sight::out_of_view) continue;
    ++violation.in_view;
    if (sight == RangeImage::Sight::possible) continue;
    const double reach = on_surface * growth * features_.voxel_size;
    if (seen_->surface.nearest(point.cast<float>(), static_cast<float>(reach)) < 0) ++violation.contradicting;
  }
  return violation;
}

FreeSpace free_space(const ScannedSpace& source, const ScannedSpace& target, const Transformation& target_from_source,
                     std::size_t most_looks) {
  return {target.violation_by(source, target_from_source, most_looks),
          source.violation_by(target, target_from_source.inverse(), most_looks)};
}

double free_space_evidence(const FreeSpace& free_space, const Features& source, const Features& target) {
  const double confirmed = confirmed_by(free_space.source) + confirmed_by(free_space.target);
  const double contradicted = decades_per_share * std::max(0.0, free_space.violation() - tolerated);
  return decades_for * confirmed * resolution(source, target) - std::min(contradicted, most_decades_against);
}

}  // namespace igsp
