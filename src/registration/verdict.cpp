#include "registration/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "registration/pose_assessment.hpp"
#include "registration/precision.hpp"
#include "registration/surface_contact.hpp"

namespace igsp {
namespace {

// Of a pose that may look right, where something else says that it is not known or not possible.
constexpr double confidence_of_what_cannot_be = 0.1;

// Of the overlap that a coarser rung sees, what the finest one sees at right poses of sparse scan lines is 0.3 and more,
// where coordinates are rounded to steps of several voxels 0.18, at a pose that is only nearly right 0.12.
constexpr double overlap_that_is_left = 0.25;

// What one scale says of a pose.
struct Judgement {
  PoseAssessment pose;
  std::vector<Rival> rivals;
  std::vector<FreeDirection> free_directions;
  double rival_odds = 0, confidence = 0;
};

// The larger the voxels, the fewer of them show what fixes a cloud: what is free must be so on the finest ones as well.
std::vector<FreeDirection> free_directions_at(ScaleLadder& scales, std::size_t rung,
                                              const Transformation& target_from_source) {
  const CommonFrame& frame = scales.frame(rung);
  std::vector<FreeDirection> free = free_directions(frame.source(), frame.target(), target_from_source);
  if (free.empty() || rung == 0) return free;
  return free_directions_at(scales, std::min<std::size_t>(rung - 1, 1), target_from_source);
}

// Other poses as a rung knows them: its own, refined there, or else those of the rung that answered.
std::vector<Rival> rivals_at(ScaleLadder& scales, std::size_t rung, const SearchOutcome& outcome) {
  if (outcome.ranked.empty()) return {};
  const double v = scales.voxel_size(rung);
  if (!outcome.ranked[rung].empty()) return distinct_rivals(outcome.ranked[rung], outcome.target_from_source, v);
  std::vector<Rival> rivals = distinct_rivals(outcome.ranked[outcome.rung], outcome.target_from_source, v);
  for (Rival& rival : rivals) rival.assessment = assess_pose(scales.frame(rung), rival.target_from_source);
  std::ranges::stable_sort(rivals, std::greater(), [](const Rival& rival) { return rival.assessment.quality; });
  return rivals;
}

Judgement judgement_at(ScaleLadder& scales, std::size_t rung, const SearchOutcome& outcome) {
  Judgement judgement;
  judgement.pose = assess_pose(scales.frame(rung), outcome.target_from_source);
  judgement.free_directions = free_directions_at(scales, rung, outcome.target_from_source);
  judgement.rivals = rivals_at(scales, rung, outcome);
  judgement.rival_odds = std::max(odds_of(judgement.rivals, judgement.pose), outcome.contradiction);
  judgement.confidence = confidence_of(judgement.pose, judgement.rival_odds);
  if (!judgement.free_directions.empty()) {
    judgement.confidence = std::min(judgement.confidence, confidence_of_what_cannot_be);
  }
  return judgement;
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
void tell_overlap(const ScaleLadder& scales, const Transformation& target_from_source, Result& result) {
  const Features &source = scales.source(), &target = scales.target();
  const double v = target.voxel_size, normal_radius = result.options.keypoints.pca_radius * v;
  Surface source_surface(source.points, PointGrid(source.points, 3.0 * v), normal_radius);
  Surface target_surface(target.points, PointGrid(target.points, 3.0 * v), normal_radius);
  result.overlap_source = overlap_of(source.points, target_surface, v, target_from_source);
  result.overlap_target = overlap_of(target.points, source_surface, v, target_from_source.inverse());
}

}  // namespace

Doubts judge(ScaleLadder& scales, const SearchOutcome& outcome, Result& result) {
  result.termination = outcome.termination;
  result.has_estimate = outcome.has_estimate;
  if (!outcome.has_estimate) return {};
  std::size_t judged = outcome.rung;
  Judgement judgement = judgement_at(scales, judged, outcome);
  for (std::size_t rung = outcome.finest_rung; rung < scales.rungs() && judgement.confidence < 0.5; ++rung) {
    if (rung == outcome.rung) continue;
    Judgement other = judgement_at(scales, rung, outcome);
    if (other.confidence <= judgement.confidence) continue;
    judgement = std::move(other);
    judged = rung;
  }
  result.evidence.voxel_size = scales.voxel_size(judged);

  const PoseAssessment& pose = judgement.pose;
  tell_overlap(scales, outcome.target_from_source, result);
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
  Doubts doubts;
  doubts.is_coarse = result.confidence >= 0.5 &&
                     std::sqrt(result.overlap_source * result.overlap_target) < overlap_that_is_left * pose.overlap();
  doubts.is_of_another_scale = result.confidence >= 0.5 && is_of_another_scale(result.precision);
  doubts.is_ambiguous = judgement.rival_odds > pose.chance_odds();
  if (doubts.is_of_another_scale || doubts.is_coarse) result.confidence = std::min(result.confidence, confidence_of_what_cannot_be);
  result.registered = result.confidence >= 0.5;
  return doubts;
}

}  // namespace igsp
