#include "registration/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "registration/free_space.hpp"
#include "registration/hypotheses.hpp"
#include "registration/pose_assessment.hpp"
#include "registration/precision.hpp"

namespace igsp {
namespace {

// Beyond this, more quality says nothing more about which of two poses is right: contact of 99.9 against 99.6 % is
// noise.
constexpr double certain_quality = 2.5;

// Q is the logarithm of the odds that a pose is right.
double odds(double quality) {
  return std::pow(10.0, quality);
}

std::string free_motions(const std::vector<FreeDirection>& directions) {
  std::string text;
  for (const FreeDirection& direction : directions) text += (text.empty() ? "" : ", ") + direction.description;
  return text;
}

std::string why_no_estimate(const Result& result) {
  switch (result.termination) {
    case Termination::too_few_keypoints:
      return fmt::format("too few keypoints: {} in the source, {} in the target; at least 3 are needed",
                         result.source.keypoints, result.target.keypoints);
    case Termination::degenerate_matches:
      return "the correspondences lie on a line and fix no rotation";
    default:
      return "no three correspondences agree on a transformation";
  }
}

std::string in_words(const Result& result) {
  const Evidence& e = result.evidence;
  std::string text = fmt::format(
      "{} of {} mutual matches agree; overlap {:.2f}; surfaces touch at {:.0f} % of the places where they meet",
      e.agreeing_matches, e.mutual_matches, result.overlap(), 100 * e.contact_share);
  if (result.runner_up) text += fmt::format("; runner-up explains {:.0f} %", 100 * result.runner_up->share);
  return text;
}

// On itself the target lies as well as it can, so a motion that it allows shows even where the estimate is poor or
// none.
void name_what_the_target_leaves_free(const CommonFrame& frame, Result& result) {
  result.precision.free_directions = free_directions(frame.target(), frame.target(), Transformation::Identity());
  if (result.precision.free_directions.empty()) return;
  result.reason += "; the target alone leaves free: " + free_motions(result.precision.free_directions);
}

// Other poses, best first, without those that say the same as the winner.
std::vector<Rival> true_rivals(const CommonFrame& frame, const SearchOutcome& outcome) {
  std::vector<Rival> rivals;
  const double v = frame.target().features.voxel_size;
  for (const Rival& rival : outcome.rivals) {
    if (!same_pose(rival.target_from_source, outcome.target_from_source, Eigen::Vector3d::Zero(), v)) {
      rivals.push_back(rival);
    }
  }
  return rivals;
}

}  // namespace

void judge(CommonFrame& frame, const SearchOutcome& outcome, Result& result) {
  result.termination = outcome.termination;
  result.has_estimate = outcome.has_estimate;
  if (!outcome.has_estimate) {
    result.reason = why_no_estimate(result);
    name_what_the_target_leaves_free(frame, result);
    return;
  }
  const PoseAssessment pose = assess_pose(frame, outcome.target_from_source);
  result.overlap_source = pose.source_on_target.overlap;
  result.overlap_target = pose.target_on_source.overlap;
  result.rmse = outcome.precision.inlier_rmse;
  result.precision = outcome.precision;
  result.precision.free_directions = free_directions(frame.source(), frame.target(), outcome.target_from_source);
  result.evidence = {pose.mutual_matches,
                     pose.agreeing_matches,
                     std::sqrt(pose.source_on_target.share * pose.target_on_source.share),
                     pose.quality,
                     0.0,
                     free_space(frame.source(), frame.target(), outcome.target_from_source)};

  const std::vector<Rival> rivals = true_rivals(frame, outcome);
  if (!rivals.empty()) {
    const double explained = static_cast<double>(rivals.front().assessment.agreeing_matches);
    const double all = std::max(1.0, static_cast<double>(pose.agreeing_matches));
    result.runner_up = RunnerUp{rivals.front().target_from_source, std::min(1.0, explained / all)};
  }
  double rival_odds = 0;
  for (const Rival& rival : rivals) {
    rival_odds += odds(std::min(rival.assessment.quality, certain_quality) - std::min(pose.quality, certain_quality));
  }
  result.evidence.rival_odds = rival_odds;

  const double chance_odds = odds(-pose.quality);
  result.confidence = 1.0 / (1.0 + chance_odds + rival_odds);
  const bool is_free = !result.precision.free_directions.empty();
  if (is_free) result.confidence = std::min(result.confidence, 0.1);
  result.registered = result.confidence >= 0.5;

  result.reason = in_words(result);
  if (is_free) result.reason += "; not fixed by the surfaces: " + free_motions(result.precision.free_directions);
  if (!result.registered && !is_free) {
    result.reason += rival_odds > chance_odds ? "; ambiguous: another pose explains the clouds about as well"
                                              : "; too little to tell it from chance";
    name_what_the_target_leaves_free(frame, result);
  }
}

}  // namespace igsp
