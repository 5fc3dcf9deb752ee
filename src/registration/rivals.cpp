#include "registration/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "registration/hypotheses.hpp"

namespace igsp {
namespace {

// Beyond this, more quality says nothing more about which of two poses is right: contact of 99.9 against 99.6 % is
// noise.
constexpr double certain_quality = 2.5;

constexpr double undecided = 0.5;  // odds of poses that a finer rung cannot tell from the answer

}  // namespace

void sort_by_quality(std::vector<Rival>& rivals) {
  std::ranges::stable_sort(rivals, std::greater(), [](const Rival& rival) { return rival.assessment.quality; });
}

std::vector<Rival> distinct_rivals(std::span<const Rival> rivals, const Transformation& pose, double voxel_size) {
  std::vector<Rival> distinct;
  for (const Rival& rival : rivals) {
    const auto repeated_by = [&](const Transformation& other) {
      return same_pose(rival.target_from_source, other, Eigen::Vector3d::Zero(), voxel_size);
    };
    if (!repeated_by(pose) && std::ranges::none_of(distinct, repeated_by, &Rival::target_from_source)) {
      distinct.push_back(rival);
    }
  }
  return distinct;
}

// Q is the logarithm of the odds that a pose is right.
double odds_of(std::span<const Rival> rivals, const PoseAssessment& against, double deciding_lead) {
  double odds = 0;
  for (const Rival& rival : rivals) {
    const double lead =
        std::min(against.quality, certain_quality) - std::min(rival.assessment.quality, certain_quality);
    odds += lead > 0 && lead < deciding_lead ? 1 : std::pow(10.0, -lead);
  }
  return odds;
}

double contradiction_by(std::span<const Rival> ranked, const Rival& pose, double voxel_size) {
  const auto place = std::ranges::find_if(ranked, [&](const Rival& other) {
    return same_pose(other.target_from_source, pose.target_from_source, Eigen::Vector3d::Zero(), voxel_size);
  });
  std::vector<Rival> rivals = distinct_rivals(ranked, pose.target_from_source, voxel_size);
  std::erase_if(rivals, [](const Rival& rival) { return rival.assessment.quality < 0; });
  // A pose that was tried there and moved away stands no better than chance.
  PoseAssessment moved_away;
  const double odds = odds_of(rivals, place == ranked.end() ? moved_away : place->assessment);
  return odds < undecided ? 0 : odds;
}

double confidence_of(const PoseAssessment& pose, double rival_odds) {
  return 1.0 / (1.0 + pose.chance_odds() + rival_odds);
}

}  // namespace igsp
