#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <limits>

#include "registration/each_pose.hpp"
#include "registration/hypotheses.hpp"
#include "registration/igsp_loop.hpp"
#include "registration/point_to_plane.hpp"
#include "registration/pose_assessment.hpp"
#include "registration/precision.hpp"
#include "registration/screening.hpp"
#include "registration/search.hpp"

namespace igsp {
namespace {

// In a common frame, descriptors of the same place differ by less than about 95 bits; 10 bits of Euclidean distance are
// one voxel at the default suppression radius.
constexpr LoopSchedule::Bounds common_frame_bounds{95.0, 10.0};
constexpr int first_hybrid_k = 4;
constexpr double hybrid_fit_scale = 1.5;  // voxels

constexpr int first_iterations = 3;
constexpr double near_enough_rad = 6.0 * M_PI / 180.0;  // for these
constexpr int last_iterations = 20;

constexpr std::array<double, 6> coarse_radii{3, 3, 2, 2, 1.5, 1.5};
// The first ones only after an answer at 8 v or 4 v, which may be that far off.
constexpr std::array<double, 9> fine_radii{12, 8, 6, 4, 3, 2, 1.5, 1.5, 1};
constexpr std::array<std::size_t, 4> first_fine_radius{4, 4, 2, 0};  // by rung
// Found at 8 v or 4 v, a pose is refined there first: from further off than a voxel of 4 v the fine surfaces of scan
// lines do not find each other.
constexpr std::size_t finest_settled = 2;  // rung
constexpr std::size_t screening_looks = 300;
constexpr std::size_t coarse_points = 1500;
constexpr std::size_t early_fine_points = 2000;
constexpr std::size_t fine_points = 8000;
constexpr std::size_t max_last_steps = 10;
// Of 500 poses of real pairs with fewer none came up to even odds, and 4 to a tenth of that: with 10 and 11 at 8 v to
// 2 v and 13 at v the first did.
constexpr std::size_t fewest_agreeing = 8;
constexpr double settled_quality = 1.5;  // decades, over other poses ...
constexpr double settled_odds = 0.1;     // of chance: no wrong pose of 124 came below 0.2
constexpr double settled_share = 1.25;   // of the agreement expected: right poses have 1.3 to 2, a square room 1.1
constexpr std::size_t carried = 3;       // from a rung to the next
// Where no pose comes up to this on the rungs so far, v hardly ever brings one to a verdict: when every pose was
// ranked, one of 114 real pairs that were searched down to v and registered lay below -2, of clouds with fewer voxels
// than these, and one right object of 1,000 simulated pairs. Now that those that hardly anything agrees with are not,
// half a decade less.
constexpr double hopeless_quality = -2.5;
constexpr double hopeful_quality = -1;       // of a pose: what a first look put off may be its rival, or better
constexpr std::size_t enough_voxels = 1500;  // of either cloud, for a pose to show a little of what it is worth

// Where both scanners are known free space and the sides of surfaces tell right from wrong among more poses.
HypothesisOptions how_many(const ScaleLadder& scales, HypothesisOptions options) {
  if (scales.space().is_known_of_both()) options.max_proposed *= 2, options.max_refined *= 2;
  return options;
}

std::vector<Hypothesis> propose(CommonFrame& frame, const Options& options) {
  const PreparedCloud &source = frame.source(), &target = frame.target();
  const double v = target.features.voxel_size;
  const HypothesisOptions& h = options.hypotheses;
  const int variants = options.degrees_of_freedom == 4 ? 2 : 4;
  const auto candidates = feature_candidates({source.keypoints, source.features.frames, source.features.descriptors},
                                             {target.keypoints, target.features.frames, target.features.descriptors},
                                             variants, h.candidates_per_keypoint, h.max_candidates, options.threads);
  const ConsistencyOptions consistency{h.length_tolerance * v, h.min_length * v, h.max_frame_angle_rad};
  const auto graph = consistency_graph(candidates, source.keypoints, target.keypoints, consistency, options.threads);
  return propose_hypotheses(candidates, graph, source.keypoints, target.keypoints, v, options);
}

template <typename Posed>
bool repeats_one_of(std::span<const Posed> others, const Transformation& pose, double voxel_size) {
  return std::any_of(others.begin(), others.end(), [&](const Posed& other) {
    return same_pose(pose, other.target_from_source, Eigen::Vector3d::Zero(), voxel_size);
  });
}

// The first `limit` that repeat neither an earlier one nor what is ranked already: matching again draws proposals
// together, and six times the same pose would leave no room for the others. Of those that too little agrees with one at
// most, so that there is an answer.
std::vector<Rematch> distinct(std::span<const Rematch> sorted, std::span<const Rival> ranked, double voxel_size,
                              int limit) {
  std::vector<Rematch> kept;
  for (const Rematch& match : sorted) {
    if (match.agreeing < fewest_agreeing && !(ranked.empty() && kept.empty())) continue;
    if (!repeats_one_of(ranked, match.target_from_source, voxel_size) &&
        !repeats_one_of(std::span<const Rematch>(kept), match.target_from_source, voxel_size)) {
      kept.push_back(match);
    }
    if (kept.size() == static_cast<std::size_t>(limit)) break;
  }
  return kept;
}

// For one of several poses that are looked into at the same time.
Options in_one_thread(Options options) {
  options.threads = 1;
  return options;
}

// With descriptors of the source in axes near those of the initial pose.
LoopOutcome hybrid_loop(CommonFrame& frame, const std::vector<Descriptor>& source_descriptors,
                        const Transformation& initial, int iterations, const Options& options,
                        const std::function<void(int)>& tick = {}) {
  const LoopInput input{frame.source().keypoints,   frame.target().keypoints,          source_descriptors, 1,
                        frame.target_descriptors(), frame.target().features.voxel_size};
  return igsp_loop(input, initial, {first_hybrid_k, iterations, hybrid_fit_scale, common_frame_bounds}, options, tick);
}

// A short refinement on the voxel centroids, before hypotheses are compared.
Transformation settle(const Surface& source, const Surface& target, const Transformation& initial, double voxel_size,
                      const Options& options) {
  return refine_point_to_plane(
      source, target, initial,
      {coarse_points, coarse_points, coarse_radii, 0, voxel_size, options.degrees_of_freedom, 1});
}

void refine(ScaleLadder& scales, const Options& options, StageClock& clock, SearchOutcome& outcome) {
  clock.start("refinement");
  if (options.refinement.enabled) {
    outcome.target_from_source = refined(scales, outcome.rung, outcome.target_from_source, options);
  }
  outcome.precision = precision_at(scales.fine_surfaces(), outcome.target_from_source, options.degrees_of_freedom);
}

// The loop at the scale that was searched, the refinement at the finest one.
void finish(ScaleLadder& scales, const Options& options, StageClock& clock, SearchOutcome& outcome) {
  CommonFrame& frame = scales.frame(outcome.rung);
  clock.start("loop");
  const int iterations = std::min(last_iterations, options.convergence.max_iterations);
  LoopOutcome loop = hybrid_loop(frame, frame.source_descriptors(outcome.target_from_source.linear()),
                                 outcome.target_from_source, iterations, options,
                                 [&](int iteration) { clock.report(static_cast<double>(iteration) / iterations); });
  outcome.termination = loop.termination;
  outcome.iterations = std::move(loop.iterations);
  if (loop.has_estimate) outcome.target_from_source = loop.target_from_source;
  refine(scales, options, clock, outcome);
}

// A few iterations of the loop and a short refinement for each, then the question that the verdict asks as well: how
// well do the clouds agree at this pose? Best first.
std::vector<Rival> rank(ScaleLadder& scales, std::size_t rung, std::span<const Transformation> candidates,
                        const Options& options) {
  CommonFrame& frame = scales.frame(rung);
  const Surface source = surface_of(frame.source()), target = surface_of(frame.target());
  const double v = frame.target().features.voxel_size;
  const Options alone = in_one_thread(options);
  // Fitted again, a proposal turns by a few degrees; the loop's first iterations do without new descriptors for that.
  frame.describe(candidates, Look::whole, near_enough_rad);
  const std::vector<Transformation> poses =
      for_each_pose<Transformation>(frame, candidates, [&](const Transformation& candidate) {
        const auto& descriptors = frame.source_descriptors(candidate.linear(), Look::whole, near_enough_rad);
        const LoopOutcome loop = hybrid_loop(frame, descriptors, candidate, first_iterations, alone);
        return settle(source, target, loop.target_from_source, v, alone);
      });
  frame.describe(poses);
  std::vector<Rival> ranked = for_each_pose<Rival>(frame, poses, [&](const Transformation& pose) {
    return Rival{pose, assess_pose(scales, rung, pose, 1)};
  });
  sort_by_quality(ranked);
  return ranked;
}

// The best one explains the clouds well, as many of its matches agree as its overlap lets expect, and no other pose
// explains them nearly as well.
bool is_settled(std::span<const Rival> ranked, double voxel_size) {
  if (ranked.empty() || ranked.front().assessment.chance_odds() > settled_odds) return false;
  if (ranked.front().assessment.share_of_expected() < settled_share) return false;
  return std::none_of(ranked.begin() + 1, ranked.end(), [&](const Rival& rival) {
    return rival.assessment.quality > ranked.front().assessment.quality - settled_quality &&
           !same_pose(rival.target_from_source, ranked.front().target_from_source, Eigen::Vector3d::Zero(), voxel_size);
  });
}

FreeSpaceQuestion question_of_free_space(ScaleLadder& scales) {
  if (!scales.space().is_known()) return {};
  return [&](const Transformation& pose) { return scales.space().at(pose, screening_looks); };
}

// What contradicts the poses that were found says nothing of those that were not.
double quality_without_free_space(const Rival& pose) {
  return pose.assessment.quality - pose.assessment.free_space_evidence;
}

// Proposes, screens and ranks; together with the best that another scale found.
std::vector<Rival> search_at(ScaleLadder& scales, std::size_t rung, std::span<const Rival> found, Options options,
                             StageClock& clock) {
  CommonFrame& frame = scales.frame(rung);
  options.hypotheses = how_many(scales, options.hypotheses);
  found = found.first(std::min(found.size(), carried));
  clock.start("hypotheses");
  const std::vector<Hypothesis> hypotheses = propose(frame, options);
  const FreeSpaceQuestion ask_free_space = question_of_free_space(scales);
  Screening screening(frame, hypotheses, options, ask_free_space);
  std::vector<Rematch> screened;
  std::vector<Transformation> tried;
  std::vector<Rival> ranked;
  const auto add_best_of = [&](std::vector<Rematch> matched) {
    if (ask_free_space)
      for (const Rematch& pose : matched) scales.space().note_proposal(pose.free_space);
    std::ranges::move(matched, std::back_inserter(screened));
    std::ranges::stable_sort(screened, std::greater(), promise_of);
    clock.start("ranking");
    std::vector<Transformation> candidates;
    if (tried.empty())
      for (const Rival& pose : found) candidates.push_back(pose.target_from_source);
    for (const Rematch& pose : distinct(screened, found, scales.voxel_size(rung), options.hypotheses.max_refined)) {
      const auto is_this = [&](const Transformation& other) {
        return other.matrix() == pose.target_from_source.matrix();
      };
      if (std::ranges::none_of(tried, is_this)) candidates.push_back(pose.target_from_source);
    }
    std::ranges::copy(candidates, std::back_inserter(tried));
    std::ranges::move(rank(scales, rung, candidates, options), std::back_inserter(ranked));
    sort_by_quality(ranked);
  };
  clock.start("screening");
  add_best_of(screening.most_promising([&](double share) { clock.report(share); }));
  const auto is_hopeful = [](const Rival& pose) { return quality_without_free_space(pose) >= hopeful_quality; };
  if (screening.has_put_off() && std::ranges::any_of(ranked, is_hopeful)) {
    clock.start("screening");
    add_best_of(screening.put_off());
  }
  return ranked;
}

// What the finer rungs say against the best pose of this one: they see what it cannot, not the other way round.
double contradiction_of(const SearchOutcome& outcome, std::size_t rung, const ScaleLadder& scales) {
  double most = 0;
  for (std::size_t finer = outcome.finest_rung; finer < rung; ++finer) {
    if (outcome.ranked[finer].empty()) continue;
    most =
        std::max(most, contradiction_by(outcome.ranked[finer], outcome.ranked[rung].front(), scales.voxel_size(rung)));
  }
  return most;
}

// Gives the outcome the pose of the rung that is most confident, if there is one.
void choose(const ScaleLadder& scales, const Options& options, SearchOutcome& outcome) {
  double most = -1;
  for (std::size_t rung = outcome.ranked.size(); rung-- > outcome.finest_rung;) {
    const std::vector<Rival>& ranked = outcome.ranked[rung];
    if (ranked.empty()) continue;
    const Rival& best = ranked.front();
    const auto rivals = distinct_rivals(ranked, best.target_from_source, scales.voxel_size(rung));
    const double contradiction = contradiction_of(outcome, rung, scales);
    const double confidence = confidence_of(best.assessment, std::max(odds_of(rivals, best.assessment), contradiction));
    // Without the refinement a pose stays as coarse as its scale: the finest one answers.
    if (confidence < most && options.refinement.enabled) continue;
    most = confidence;
    outcome.has_estimate = true;
    outcome.rung = rung;
    outcome.target_from_source = best.target_from_source;
    outcome.contradiction = contradiction;
  }
}

// Whether voxels of 2 v show of every pose at least a little of what it is worth.
bool can_tell(std::size_t rung, const CommonFrame& frame) {
  return rung == 1 &&
         std::min(frame.source().features.points.size(), frame.target().features.points.size()) >= enough_voxels;
}

}  // namespace

Transformation refined(ScaleLadder& scales, std::size_t rung, const Transformation& target_from_source,
                       const Options& options) {
  Transformation pose = target_from_source;
  for (std::size_t k = rung; k >= finest_settled; --k) {
    CommonFrame& frame = scales.frame(k);
    pose = settle(surface_of(frame.source()), surface_of(frame.target()), pose, scales.voxel_size(k), options);
  }
  FineSurfaces& surfaces = scales.fine_surfaces();
  const auto radii = std::span(fine_radii).subspan(first_fine_radius[rung]);
  return refine_point_to_plane(surfaces.source, surfaces.target, pose,
                               {early_fine_points, fine_points, radii, max_last_steps, scales.voxel_size(0),
                                options.degrees_of_freedom, options.threads});
}

SearchOutcome hypotheses_search(ScaleLadder& scales, const Options& options, StageClock& clock) {
  SearchOutcome outcome;
  outcome.ranked.resize(scales.rungs());
  std::span<const Rival> found;
  double quality = std::numeric_limits<double>::lowest();
  for (std::size_t rung = scales.rungs(); rung-- > 0;) {
    CommonFrame& frame = scales.frame(rung);
    outcome.ranked[rung] = search_at(scales, rung, found, options, clock);
    found = outcome.ranked[rung];
    for (const Rival& pose : found) quality = std::max(quality, quality_without_free_space(pose));
    outcome.finest_rung = rung;
    const bool is_hopeless = can_tell(rung, frame) && quality < hopeless_quality;
    if (is_hopeless || (options.refinement.enabled && is_settled(found, scales.voxel_size(rung)))) break;
  }
  choose(scales, options, outcome);
  if (!outcome.has_estimate) return outcome;
  finish(scales, options, clock, outcome);
  return outcome;
}

SearchOutcome refine_initial(ScaleLadder& scales, const Transformation& initial, const Options& options,
                             StageClock& clock) {
  SearchOutcome outcome;
  outcome.has_estimate = true;
  outcome.target_from_source = initial;
  finish(scales, options, clock, outcome);
  return outcome;
}

}  // namespace igsp
