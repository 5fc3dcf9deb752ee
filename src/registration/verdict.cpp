#include "registration/verdict.hpp"

#include <fmt/format.h>

#include <cmath>

#include "registration/hypotheses.hpp"
#include "registration/pose_assessment.hpp"

namespace igsp {
namespace {

constexpr double min_quality = 0.60;

std::string evidence(const PoseAssessment& pose) {
  return fmt::format("{} of {} mutual matches agree; surfaces touch at {:.0f} % of the places where they meet",
                     pose.agreeing_matches, pose.mutual_matches,
                     100 * std::sqrt(pose.source_on_target.share * pose.target_on_source.share));
}

std::string why_no_estimate(const Result& result) {
  switch (result.termination) {
    case Termination::too_few_keypoints:
      return fmt::format("too few keypoints: {} in the source, {} in the target; at least 3 are needed",
                         result.source.keypoints, result.target.keypoints);
    case Termination::degenerate_matches: return "the correspondences lie on a line and fix no rotation";
    default: return "no three correspondences agree on a transformation";
  }
}

}  // namespace

void judge(CommonFrame& frame, const SearchOutcome& outcome, Result& result) {
  if (!outcome.has_estimate) {
    result.reason = why_no_estimate(result);
    return;
  }
  const PoseAssessment pose = assess_pose(frame, outcome.target_from_source);
  result.overlap_source = pose.source_on_target.overlap;
  result.overlap_target = pose.target_on_source.overlap;
  result.rmse = pose.source_on_target.rmse;

  const Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double odds_against = std::pow(10.0, 3 * (min_quality - pose.quality));
  double rivals = 0;
  for (const Transformation& rival : outcome.rivals) {
    if (same_pose(rival, outcome.target_from_source, centre, frame.target().features.voxel_size)) continue;
    rivals += std::pow(10.0, 3 * (assess_pose(frame, rival).quality - pose.quality));
  }
  result.confidence = 1.0 / (1.0 + odds_against + rivals);
  result.registered = result.confidence >= 0.5;
  result.reason = evidence(pose);
  if (!result.registered) {
    result.reason += rivals > odds_against ? "; another pose explains the clouds about as well" : "; too little to tell it from chance";
  }
}

}  // namespace igsp
