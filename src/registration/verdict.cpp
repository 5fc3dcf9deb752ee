#include "registration/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "registration/hypotheses.hpp"
#include "registration/pose_assessment.hpp"
#include "registration/precision.hpp"
#include "registration/surface_contact.hpp"

namespace igsp {
namespace {

// Beyond this, more quality says nothing more about which of two poses is right: contact of 99.9 against 99.6 % is
// noise.
constexpr double certain_quality = 2.5;

// Of a pose that may look right, where something else says that it is not known or not possible.
constexpr double confidence_of_what_cannot_be = 0.1;

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

// Other poses, best first, each once: without those that say the same as the winner or as a better rival.
std::vector<Rival> true_rivals(const SearchOutcome& outcome, double v) {
  std::vector<Rival> rivals;
  for (const Rival& rival : outcome.rivals) {
    const auto repeated_by = [&](const Transformation& pose) {
      return same_pose(rival.target_from_source, pose, Eigen::Vector3d::Zero(), v);
    };
    if (!repeated_by(outcome.target_from_source) &&
        std::ranges::none_of(rivals, repeated_by, [](const Rival& better) { return better.target_from_source; })) {
      rivals.push_back(rival);
    }
  }
  return rivals;
}

// What one scale says of a pose.
struct Judgement {
  PoseAssessment pose;
  std::vector<Rival> rivals;
  std::vector<FreeDirection> free_directions;
  double rival_odds = 0, confidence = 0;
};

double confidence_of(const Judgement& judgement) {
  const double confidence = 1.0 / (1.0 + judgement.pose.chance_odds() + judgement.rival_odds);
  return judgement.free_directions.empty() ? confidence : std::min(confidence, confidence_of_what_cannot_be);
}

Judgement judgement_of(CommonFrame& frame, const Transformation& target_from_source, std::vector<Rival> rivals) {
  Judgement judgement;
  judgement.pose = assess_pose(frame, target_from_source);
  judgement.free_directions = free_directions(frame.source(), frame.target(), target_from_source);
  const double quality = std::min(judgement.pose.quality, certain_quality);
  for (const Rival& rival : rivals) {
    judgement.rival_odds += odds(std::min(rival.assessment.quality, certain_quality) - quality);
  }
  judgement.rivals = std::move(rivals);
  judgement.confidence = confidence_of(judgement);
  return judgement;
}

std::vector<Rival> assessed_at(CommonFrame& frame, std::vector<Rival> rivals) {
  for (Rival& rival : rivals) rival.assessment = assess_pose(frame, rival.target_from_source);
  std::ranges::stable_sort(rivals, std::greater(), [](const Rival& rival) { return rival.assessment.quality; });
  return rivals;
}

// The best other pose, by its matches.
std::optional<RunnerUp> runner_up_of(const Judgement& judgement) {
  if (judgement.rivals.empty()) return std::nullopt;
  const auto explained = static_cast<double>(judgement.rivals.front().assessment.agreeing_matches);
  const double all = std::max(1.0, static_cast<double>(judgement.pose.agreeing_matches));
  return RunnerUp{judgement.rivals.front().target_from_source, std::min(1.0, explained / all)};
}

// Always at the finer scale, so that it means the same whichever scale the verdict was asked at; with normals of its
// own, of the places that are met, since most pairs come here before that scale is made ready.
void tell_overlap(const FinerScale& finer, const Transformation& target_from_source, Result& result) {
  const Features &source = finer.source(), &target = finer.target();
  const double v = target.voxel_size, normal_radius = result.options.keypoints.pca_radius * v;
  Surface source_surface(source.points, PointGrid(source.points, 3.0 * v), normal_radius);
  Surface target_surface(target.points, PointGrid(target.points, 3.0 * v), normal_radius);
  result.overlap_source = overlap_of(source.points, target_surface, v, target_from_source);
  result.overlap_target = overlap_of(target.points, source_surface, v, target_from_source.inverse());
}

std::string why_refused(const Judgement& judgement) {
  return judgement.rival_odds > judgement.pose.chance_odds()
             ? "; ambiguous: another pose explains the clouds about as well"
             : "; too little to tell it from chance";
}

}  // namespace

void judge(FinerScale& finer, CoarserScale& coarser, const SearchOutcome& outcome, Result& result) {
  result.termination = outcome.termination;
  result.has_estimate = outcome.has_estimate;
  if (!outcome.has_estimate) {
    result.reason = why_no_estimate(result);
    name_what_the_target_leaves_free(finer.frame(), result);
    return;
  }
  CommonFrame& first = outcome.settled_coarse ? coarser.frame() : finer.frame();
  const std::vector<Rival> rivals = true_rivals(outcome, first.target().features.voxel_size);
  Judgement judgement = judgement_of(first, outcome.target_from_source, rivals);
  result.evidence.voxel_size = first.target().features.voxel_size;
  if (judgement.confidence < 0.5 && coarser.is_there()) {
    CommonFrame& second = outcome.settled_coarse ? finer.frame() : coarser.frame();
    Judgement other = judgement_of(second, outcome.target_from_source, assessed_at(second, rivals));
    if (other.confidence > judgement.confidence) {
      judgement = std::move(other);
      result.evidence.voxel_size = second.target().features.voxel_size;
    }
  }

  const PoseAssessment& pose = judgement.pose;
  tell_overlap(finer, outcome.target_from_source, result);
  result.rmse = outcome.precision.inlier_rmse;
  result.precision = outcome.precision;
  result.precision.free_directions = judgement.free_directions;
  result.evidence.mutual_matches = pose.mutual_matches;
  result.evidence.agreeing_matches = pose.agreeing_matches;
  result.evidence.contact_share = std::sqrt(pose.source_on_target.share * pose.target_on_source.share);
  result.evidence.quality = pose.quality;
  result.evidence.rival_odds = judgement.rival_odds;
  result.evidence.free_space = pose.free_space;
  result.runner_up = runner_up_of(judgement);
  result.confidence = judgement.confidence;
  const bool other_scale = result.confidence >= 0.5 && is_of_another_scale(result.precision);
  if (other_scale) result.confidence = std::min(result.confidence, confidence_of_what_cannot_be);
  result.registered = result.confidence >= 0.5;

  const bool is_free = !judgement.free_directions.empty();
  result.reason = in_words(result);
  if (is_free) result.reason += "; not fixed by the surfaces: " + free_motions(judgement.free_directions);
  if (other_scale) {
    result.reason +=
        fmt::format("; in another scale: the source fits best multiplied by {:.3f}, which no rigid motion does",
                    result.precision.scale);
  }
  if (!result.registered && !is_free && !other_scale) {
    result.reason += why_refused(judgement);
    name_what_the_target_leaves_free(finer.frame(), result);
  }
}

}  // namespace igsp
