#include <algorithm>
#include <iterator>
#include <limits>

#include "registration/hypotheses.hpp"
#include "registration/one_scale_search.hpp"
#include "registration/pose_refinement.hpp"
#include "registration/precision.hpp"
#include "registration/search.hpp"

namespace igsp {
namespace {

constexpr int last_iterations = 20;

constexpr double settled_quality = 1.5;  // decades, over other poses ...
constexpr double settled_odds = 0.1;     // of chance: no wrong pose of 124 came below 0.2
constexpr double settled_share = 1.25;   // of the agreement expected: right poses have 1.3 to 2, a square room 1.1
constexpr std::size_t carried = 3;       // from a rung to the next
// Where no pose comes up to this on the rungs so far, v hardly ever brings one to a verdict: when every pose was
// ranked, one of 114 real pairs that were searched down to v and registered lay below -2, of clouds with fewer voxels
// than these, and one right object of 1,000 simulated pairs. Now that those that hardly anything agrees with are not,
// half a decade less. Nor is such a pose worth a look at v where another one leads there.
constexpr double hopeless_quality = -2.5;
constexpr std::size_t enough_voxels = 1500;  // of either cloud, for a pose to show a little of what it is worth

void refine(ScaleLadder& scales, const Options& options, StageClock& clock, SearchOutcome& outcome) {
  clock.start("refinement");
  if (options.refinement.enabled) {
    outcome.target_from_source = refined(scales, outcome.rung, outcome.target_from_source, options, outcome.is_hopeful);
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
    outcome.is_hopeful = is_hopeful(best);
    outcome.contradiction = contradiction;
  }
}

// Whether voxels of 2 v show of every pose at least a little of what it is worth.
bool can_tell(std::size_t rung, const CommonFrame& frame) {
  return rung == 1 &&
         std::min(frame.source().features.points.size(), frame.target().features.points.size()) >= enough_voxels;
}

}  // namespace

SearchOutcome hypotheses_search(ScaleLadder& scales, const Options& options, StageClock& clock) {
  SearchOutcome outcome;
  outcome.ranked.resize(scales.rungs());
  std::vector<Rival> found, hopeless;
  double quality = std::numeric_limits<double>::lowest();
  for (std::size_t rung = scales.rungs(); rung-- > 0;) {
    CommonFrame& frame = scales.frame(rung);
    std::vector<Rival>& ranked = outcome.ranked[rung];
    ranked = search_at(scales, rung, found, options, clock);
    // What 2 v says of those that v does not look into goes on counting against them.
    std::ranges::copy(hopeless, std::back_inserter(ranked));
    sort_by_quality(ranked);
    outcome.finest_rung = rung;
    for (const Rival& pose : ranked) quality = std::max(quality, quality_without_free_space(pose));
    const bool is_hopeless = can_tell(rung, frame) && quality < hopeless_quality;
    if (is_hopeless || (options.refinement.enabled && is_settled(ranked, scales.voxel_size(rung)))) break;
    found.assign(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(std::min(ranked.size(), carried)));
    if (can_tell(rung, frame)) {
      const auto others = std::stable_partition(found.begin(), found.end(), [](const Rival& pose) {
        return quality_without_free_space(pose) >= hopeless_quality;
      });
      hopeless.assign(others, found.end());
      found.erase(others, found.end());
    }
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
