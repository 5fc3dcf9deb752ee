#pragma once

#include <span>
#include <vector>

#include "registration/pose_assessment.hpp"

namespace igsp {

/// A pose that was looked into beside the best one.
struct Rival {
  Transformation target_from_source;
  PoseAssessment assessment;
};

void sort_by_quality(std::vector<Rival>& rivals);  ///< best first

/// Each once, without those that say the same as `pose` or as an earlier one.
std::vector<Rival> distinct_rivals(std::span<const Rival> rivals, const Transformation& pose, double voxel_size);

/// Odds that one of the rivals is right, against the pose of this assessment; even for each that it leads by less than
/// so many decades.
double odds_of(std::span<const Rival> rivals, const PoseAssessment& against, double deciding_lead = 0);

/// What the ranking of another rung says against `pose`: the odds of the poses there that more than chance speaks for,
/// against the place of `pose` among them. 0 where they hardly weigh: the rung of an answer knows best.
double contradiction_by(std::span<const Rival> ranked, const Rival& pose, double voxel_size);

/// That a pose is right: neither chance nor one of its rivals is, [0, 1].
double confidence_of(const PoseAssessment& pose, double rival_odds);

}  // namespace igsp
