#include "registration/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "registration/pose_assessment.hpp"
#include "registration/pose_refinement.hpp"
#include "registration/precision.hpp"
#include "registration/self_likeness.hpp"
#include "registration/surface_contact.hpp"

namespace igsp {
namespace {

// Of two poses less apart than this the better one is right no more often than the other: of 10 answers for tables and
// benches, with half a turn of theirs behind by 0.1 to 0.55 decades, that were registered for it, 5 were right.
constexpr double deciding_lead = 0.6;  // decades

constexpr double near_quality = 1.5;  // decades below the answer's

// Of the overlap that a coarser rung sees, the finest one sees little where a pose is only nearly right or coordinates
// come in steps of several voxels, and at right poses of scan lines that lie beside each other. These lie on the
// surface wherever they are beside it (0.82 and more of 17 simulated pairs), those mostly do not (0.55 and less).
constexpr double overlap_that_is_left = 0.25;
constexpr double lying_on_it = 0.7;
constexpr double places_of_no_weight = 10;  // that many beside a surface prove nothing
// From so much on the surfaces are closed at v, and what the finest rung says against a pose has nothing to do with
// sparse lines: a corridor with equal doors 0.95, with a confidence of 0.80 at 4 v and 0.02 at v; scan lines to 0.65.
constexpr double overlap_of_closed_surfaces = 0.7;
constexpr double contradicted = 0.2;  // like rooms, half a turn off: 0.01 to 0.12 at v

// What one rung says of a pose.
struct Judgement {
  std::size_t rung = 0;
  PoseAssessment pose;
  std::vector<Rival> rivals;
  std::vector<FreeDirection> free_directions;
  double rival_odds = 0, confidence = 0;
};

// The larger the voxels, the fewer of them show what fixes a cloud: what is free must be so on the finest ones as well.
std::vector<FreeDirection> free_directions_at(ScaleLadder& scales, std::size_t rung,
                                              const Transformation& target_from_source) {
  const CommonFrame& frame = scales.frame(rung);
  std::vector<FreeDirection> free =
      free_directions(frame.source(), frame.target(), target_from_source, scales.threads());
  if (free.empty() || rung == 0) return free;
  return free_directions_at(scales, std::min<std::size_t>(rung - 1, 1), target_from_source);
}

// Other poses as a rung knows them: its own, refined there, or else those of the rung that answered.
std::vector<Rival> rivals_at(ScaleLadder& scales, std::size_t rung, const SearchOutcome& outcome) {
  if (outcome.ranked.empty()) return {};
  const double v = scales.voxel_size(rung);
  if (!outcome.ranked[rung].empty()) return distinct_rivals(outcome.ranked[rung], outcome.target_from_source, v);
  std::vector<Rival> rivals = distinct_rivals(outcome.ranked[outcome.rung], outcome.target_from_source, v);
  for (Rival& rival : rivals) rival.assessment = assess_pose(scales, rung, rival.target_from_source, scales.threads());
  sort_by_quality(rivals);
  return rivals;
}

void weigh(const SearchOutcome& outcome, Judgement& judgement) {
  judgement.rival_odds = std::max(odds_of(judgement.rivals, judgement.pose, deciding_lead), outcome.contradiction);
  judgement.confidence = confidence_of(judgement.pose, judgement.rival_odds);
  if (!judgement.free_directions.empty()) {
    judgement.confidence = std::min(judgement.confidence, confidence_of_what_cannot_be);
  }
}

Judgement judgement_of(const PoseAssessment& pose, ScaleLadder& scales, std::size_t rung,
                       const SearchOutcome& outcome) {
  Judgement judgement;
  judgement.rung = rung;
  judgement.pose = pose;
  judgement.free_directions = free_directions_at(scales, rung, outcome.target_from_source);
  judgement.rivals = rivals_at(scales, rung, outcome);
  weigh(outcome, judgement);
  return judgement;
}

Judgement judgement_at(ScaleLadder& scales, std::size_t rung, const SearchOutcome& outcome) {
  return judgement_of(assess_pose(scales, rung, outcome.target_from_source, scales.threads()), scales, rung, outcome);
}

// The answer has been refined since the poses were ranked; those that came near it get the same chance.
void refine_rivals(ScaleLadder& scales, const SearchOutcome& outcome, const Options& options, Judgement& judgement) {
  const std::size_t rung = judgement.rung;
  bool is_changed = false;
  for (Rival& rival : judgement.rivals) {
    const double quality = rival.assessment.quality;
    if (quality < 0 || quality < judgement.pose.quality - near_quality) break;
    const Transformation pose = refined(scales, rung, rival.target_from_source, options);
    const PoseAssessment assessment = assess_pose(scales, rung, pose, scales.threads());
    if (assessment.quality > quality) rival = {pose, assessment}, is_changed = true;
  }
  if (!is_changed) return;
  sort_by_quality(judgement.rivals);
  judgement.rivals = distinct_rivals(judgement.rivals, outcome.target_from_source, scales.voxel_size(rung));
  weigh(outcome, judgement);
}

// Where one of the clouds lies on itself after a turn the other fits as well turned, whether or not a search came
// across that pose, and whatever the matches say, which see how the clouds are sampled. Only free space may tell them
// apart.
void add_turned_rivals(ScaleLadder& scales, const SearchOutcome& outcome, const Options& options,
                       Judgement& judgement) {
  constexpr double upright = 0.999;  // cosine of the tilt
  const std::size_t rung = judgement.rung;
  const auto add = [&](const Transformation& turn, const Transformation& pose) {
    if (options.degrees_of_freedom == 4 && turn.linear()(2, 2) < upright) return;
    Rival rival{pose, assess_pose(scales, rung, pose, scales.threads())};
    const double told_apart = judgement.pose.free_space_evidence - rival.assessment.free_space_evidence;
    rival.assessment.quality = std::max(rival.assessment.quality, judgement.pose.quality - std::max(0.0, told_apart));
    judgement.rivals.push_back(rival);
  };
  for (const Transformation& turn : turns_onto_itself(scales.frame(rung).target())) {
    add(turn, turn * outcome.target_from_source);
  }
  for (const Transformation& turn : turns_onto_itself(scales.frame(rung).source())) {
    add(turn, outcome.target_from_source * turn);
  }
  sort_by_quality(judgement.rivals);
  judgement.rivals = distinct_rivals(judgement.rivals, outcome.target_from_source, scales.voxel_size(rung));
  weigh(outcome, judgement);
}

// Shifts after which a cloud still lies on itself.
std::vector<FreeDirection> shifts_onto_itself(const PreparedCloud& cloud, int threads) {
  constexpr double shift = 0.9;  // of the length of a motion
  std::vector<FreeDirection> found = free_directions(cloud, cloud, Transformation::Identity(), threads);
  std::erase_if(found, [](const FreeDirection& free) { return free.motion.tail<3>().norm() < shift; });
  return found;
}

// Along a corridor with equal doors either cloud slides on itself. A door leaf that one scan saw by chance must not fix
// at a pose what neither cloud fixes at 2 v and one of them does not at v.
std::vector<FreeDirection> shifts_of_both(ScaleLadder& scales, std::size_t rung,
                                          const Transformation& target_from_source) {
  constexpr double same_line = 0.93;  // cosine
  struct Shifts {
    std::vector<FreeDirection> target, source;
  };
  const auto shifts_at = [&](std::size_t at) -> Shifts {
    return {shifts_onto_itself(scales.frame(at).target(), scales.threads()),
            shifts_onto_itself(scales.frame(at).source(), scales.threads())};
  };
  // Of most pairs the rung that is there already tells that nothing slides, and no other has to be made.
  const Shifts here = shifts_at(rung);
  const bool is_target_fixed = here.target.empty(), is_source_fixed = here.source.empty();
  if (rung == 0 ? is_target_fixed && is_source_fixed : is_target_fixed || is_source_fixed) return {};
  const auto has = [&](const std::vector<FreeDirection>& shifts, const Eigen::Vector3d& line) {
    return std::ranges::any_of(shifts, [&](const FreeDirection& other) {
      return std::abs(other.motion.tail<3>().normalized().dot(line.normalized())) > same_line;
    });
  };
  const auto has_source = [&](const Shifts& shifts, const FreeDirection& free) {
    return has(shifts.source, target_from_source.linear().transpose() * free.motion.tail<3>());
  };
  const std::size_t coarse = std::min<std::size_t>(1, scales.rungs() - 1);
  const Shifts at_2v = coarse == rung ? here : shifts_at(coarse);
  std::vector<FreeDirection> found = at_2v.target;
  std::erase_if(found, [&](const FreeDirection& free) { return !has_source(at_2v, free); });
  if (found.empty()) return {};
  const Shifts at_v = rung == 0 ? here : shifts_at(0);
  std::erase_if(found, [&](const FreeDirection& free) {
    return !has(at_v.target, free.motion.tail<3>()) && !has_source(at_v, free);
  });
  return found;
}

// The rung that answered or, where it does not carry the answer, another one.
Judgement most_confident(ScaleLadder& scales, const SearchOutcome& outcome) {
  // Where nothing was searched no rival is known, and large voxels alone hardly tell poses apart.
  const std::size_t rungs = outcome.ranked.empty() ? std::min<std::size_t>(2, scales.rungs()) : scales.rungs();
  Judgement judgement = judgement_at(scales, outcome.rung, outcome);
  for (std::size_t rung = outcome.finest_rung; rung < rungs && judgement.confidence < 0.5; ++rung) {
    if (rung == outcome.rung) continue;
    const PoseAssessment pose = assess_pose(scales, rung, outcome.target_from_source, scales.threads());
    // Rivals and free directions, which cost most, only lower it.
    if (confidence_of(pose, outcome.contradiction) <= judgement.confidence) continue;
    Judgement other = judgement_of(pose, scales, rung, outcome);
    if (other.confidence > judgement.confidence) judgement = std::move(other);
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
struct FinestOverlap {
  SurfaceOverlap source, target;
  double geometric_mean() const { return std::sqrt(source.share() * target.share()); }
  // Of the places beside the other cloud's surface, the share on it.
  double lying() const {
    const auto covered = static_cast<double>(source.covered + target.covered);
    return covered / (static_cast<double>(source.met + target.met) + places_of_no_weight);
  }
};

FinestOverlap finest_overlap(const ScaleLadder& scales, const Transformation& target_from_source,
                             const Options& options) {
  const Features &source = scales.source(), &target = scales.target();
  const double v = target.voxel_size, normal_radius = options.keypoints.pca_radius * v;
  const auto overlap = [&](const Features& moved, const Features& fixed, const Transformation& fixed_from_moved) {
    const Surface surface(fixed.points, PointGrid(fixed.points, 3.0 * v), normal_radius);
    return overlap_of(moved.points, surface, v, fixed_from_moved);
  };
  FinestOverlap found;
  parallel_pair(
      options.threads, [&] { found.source = overlap(source, target, target_from_source); },
      [&] { found.target = overlap(target, source, target_from_source.inverse()); });
  return found;
}

}  // namespace

Doubts judge(ScaleLadder& scales, const SearchOutcome& outcome, Result& result) {
  result.termination = outcome.termination;
  result.has_estimate = outcome.has_estimate;
  if (!outcome.has_estimate) return {};
  const FinestOverlap at_v = finest_overlap(scales, outcome.target_from_source, result.options);
  result.overlap_source = at_v.source.share();
  result.overlap_target = at_v.target.share();
  Judgement judgement = most_confident(scales, outcome);
  if (judgement.confidence >= 0.5 && result.options.refinement.enabled) {
    refine_rivals(scales, outcome, result.options, judgement);
  }
  if (judgement.confidence >= 0.5 && !outcome.ranked.empty()) {
    add_turned_rivals(scales, outcome, result.options, judgement);
  }
  if (judgement.confidence >= 0.5) {
    judgement.free_directions = shifts_of_both(scales, judgement.rung, outcome.target_from_source);
    weigh(outcome, judgement);
  }
  const bool is_closed_at_v = at_v.geometric_mean() >= overlap_of_closed_surfaces * judgement.pose.overlap();
  if (judgement.confidence >= 0.5 && judgement.rung > outcome.finest_rung && is_closed_at_v) {
    Judgement finest = judgement_at(scales, outcome.finest_rung, outcome);
    if (finest.confidence < contradicted) judgement = std::move(finest);
  }
  result.evidence.voxel_size = scales.voxel_size(judgement.rung);

  const PoseAssessment& pose = judgement.pose;
  result.rmse = outcome.precision.inlier_rmse;
  result.precision = outcome.precision;
  result.precision.free_directions = judgement.free_directions;
  result.evidence.mutual_matches = pose.mutual_matches;
  result.evidence.agreeing_matches = pose.agreeing_matches;
  result.evidence.contact_share = pose.contact();
  result.evidence.quality = pose.quality;
  result.evidence.rival_odds = judgement.rival_odds;
  result.evidence.free_space = pose.free_space;
  result.runner_up = runner_up_of(judgement);
  result.confidence = judgement.confidence;
  Doubts doubts;
  doubts.is_coarse = result.confidence >= 0.5 && at_v.lying() < lying_on_it &&
                     at_v.geometric_mean() < overlap_that_is_left * pose.overlap();
  doubts.is_of_another_scale = result.confidence >= 0.5 && is_of_another_scale(result.precision);
  doubts.is_ambiguous = judgement.rival_odds > pose.chance_odds();
  if (doubts.is_of_another_scale || doubts.is_coarse) {
    result.confidence = std::min(result.confidence, confidence_of_what_cannot_be);
  }
  return doubts;
}

}  // namespace igsp
