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

// Fitted on simulated pairs of known truth, docs/verdict.md.
constexpr double even_quality = 0.65;  // Q at which a pose is as likely right as wrong
constexpr double steepness = 2.0;      // decades of the odds per unit of Q

// Beyond this, more quality says nothing more about which of two poses is right: contact of 99.9 against 99.6 % is
// noise.
constexpr double certain_quality = 1.5;

double odds(double quality) {
  return std::pow(10.0, steepness * quality);
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

std::string percent(double share) {
  return share < 0.0995 ? fmt::format("{:.1f} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

// Of each scan, as far as the other one's scanner can tell.
std::string seen_through(const FreeSpace& free_space) {
  const auto part = [](const FreeSpaceViolation& violation, std::string_view cloud) {
    return fmt::format("{} of the {}", percent(violation.share()), cloud);
  };
  std::string parts;
  if (free_space.source) parts = part(*free_space.source, "source");
  if (free_space.target) parts += (parts.empty() ? "" : " and ") + part(*free_space.target, "target");
  return parts.empty() ? "" : "; " + parts + " in space that the other scanner saw through";
}

std::string in_words(const Result& result) {
  const Evidence& e = result.evidence;
  std::string text = fmt::format(
      "{} of {} mutual matches agree; overlap {:.2f}; surfaces touch at {:.0f} % of the places where they meet",
      e.agreeing_matches, e.mutual_matches, result.overlap(), 100 * e.contact_share);
  text += seen_through(e.free_space);
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

  const double chance_odds = odds(even_quality - pose.quality);
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
