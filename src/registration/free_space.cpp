#include "registration/free_space.hpp"

#include <algorithm>
#include <cmath>

namespace igsp {
namespace {

// Surfaces end somewhere between two points and may be met at a grazing angle: what lies on one that was seen, or just
// beyond its rim, does not contradict, however it is seen.
constexpr double beside_surface = 3.0;  // voxels

// People walk, leaves move, rims are met at a grazing angle: right poses of real scans are contradicted by so much,
// hardly one by more.
constexpr double tolerated = 0.035;
constexpr double decades_per_share = 20, most_decades_against = 2;  // beyond what is tolerated

// A pose that nothing contradicts gains by the rarity of that among the proposals, of which a little is asked of every
// pose: scenes whose proposals are not contradicted are like themselves elsewhere.
constexpr double decades_for = 1.3, asked_for = 0.4;
constexpr double most_rarity = 2;             // decades
constexpr double alike_in_violation = 0.003;  // violations, of a few hundred looks
constexpr double convincing_view = 100;       // points in view for half of that

// Points in view that agree, added to those that are there: few prove little.
constexpr double assumed_agreeing = 20;

// An even selection of about as many.
template <typename Look>
void for_some_of(const Points& points, std::size_t most, const Look& look) {
  const std::size_t stride = std::max<std::size_t>(1, points.size() / most);
  for (std::size_t i = 0; i < points.size(); i += stride) look(points[i]);
}

double conviction_of(const FreeSpaceViolation& violation) {
  const double in_view = static_cast<double>(violation.in_view);
  return in_view / (in_view + convincing_view);
}

}  // namespace

double FreeSpaceViolation::share() const {
  return static_cast<double>(contradicting) / (static_cast<double>(in_view) + assumed_agreeing);
}

double FreeSpace::violation() const {
  return std::max(source ? source->share() : 0.0, target ? target->share() : 0.0);
}

ScannedSpace::ScannedSpace(const Features& features) : features_(features) {
  if (features.viewpoint) images_.emplace_back(features.fine_points, *features.viewpoint, features.voxel_size);
  for (const ScannedPart& part : features.parts) {
    images_.emplace_back(part.fine_points, part.viewpoint, features.voxel_size);
  }
  if (is_known()) surface_.emplace(features.points, beside_surface * features.voxel_size);
}

bool ScannedSpace::is_on_surface(const Eigen::Vector3d& point, double growth) const {
  const double reach = beside_surface * growth * features_.voxel_size;
  return surface_->nearest(point.cast<float>(), static_cast<float>(reach)) >= 0;
}

ScannedSpace::Sight ScannedSpace::look_at(const Eigen::Vector3d& point) const {
  Sight sight = Sight::out_of_view;
  for (const RangeImage& image : images_) {
    const RangeImage::Look look = image.look_at(point);
    if (look.sight == RangeImage::Sight::out_of_view) continue;
    if (look.sight == RangeImage::Sight::empty && !is_on_surface(point, look.growth)) return Sight::contradicts;
    sight = Sight::possible;
  }
  return sight;
}

std::optional<FreeSpaceViolation> ScannedSpace::violation_by(const ScannedSpace& moved,
                                                             const Transformation& this_from_moved,
                                                             std::size_t most_looks) const {
  if (!is_known()) return {};
  FreeSpaceViolation violation;
  for_some_of(moved.features_.points, most_looks, [&](const Eigen::Vector3d& point) {
    const Sight sight = look_at(this_from_moved * point);
    violation.in_view += sight != Sight::out_of_view;
    violation.contradicting += sight == Sight::contradicts;
  });
  return violation;
}

std::size_t ScannedSpace::met_by(const ScannedSpace& moved, const Transformation& this_from_moved,
                                 std::size_t most_looks) const {
  if (!is_known()) return 0;
  std::size_t met = 0;
  for_some_of(moved.features_.points, most_looks,
              [&](const Eigen::Vector3d& point) { met += is_on_surface(this_from_moved * point, 1); });
  return met;
}

double free_space_evidence(const FreeSpace& free_space, double rarity, double weight) {
  const double violation = free_space.violation();
  const double uncontradicted = std::max(0.0, 1 - violation / tolerated);
  const double gained = decades_for * std::min(rarity, most_rarity) * weight * uncontradicted;
  double evidence = 0;
  for (const auto& direction : {free_space.source, free_space.target}) {
    if (direction) evidence += 0.5 * (gained * conviction_of(*direction) - asked_for);
  }
  return evidence - std::min(decades_per_share * std::max(0.0, violation - tolerated), most_decades_against);
}

double PairSpace::evidence(const FreeSpace& free_space, double weight) const {
  if (proposed_.empty()) return free_space_evidence(free_space, usual_rarity, weight);
  const double limit = free_space.violation() + alike_in_violation;
  const auto as_little = static_cast<double>(std::ranges::count_if(proposed_, [&](double v) { return v <= limit; }));
  return free_space_evidence(free_space, std::log10((static_cast<double>(proposed_.size()) + 2) / (as_little + 1)),
                             weight);
}

}  // namespace igsp
