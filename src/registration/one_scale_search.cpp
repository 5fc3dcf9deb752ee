#include "registration/one_scale_search.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "registration/each_pose.hpp"
#include "registration/hypotheses.hpp"
#include "registration/pose_assessment.hpp"
#include "registration/pose_refinement.hpp"
#include "registration/screening.hpp"

namespace igsp {
namespace {

constexpr int first_iterations = 3;
constexpr double near_enough_rad = 6.0 * M_PI / 180.0;  // for these
constexpr std::size_t screening_looks = 300;
// Of 500 poses of real pairs with fewer none came up to even odds, and 4 to a tenth of that: with 10 and 11 at 8 v to
// 2 v and 13 at v the first did.
constexpr std::size_t fewest_agreeing = 8;
constexpr double hopeful_quality = -1;

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

FreeSpaceQuestion question_of_free_space(ScaleLadder& scales) {
  if (!scales.space().is_known()) return {};
  return [&](const Transformation& pose) { return scales.space().at(pose, screening_looks); };
}

// For one of several poses that are looked into at the same time.
Options in_one_thread(Options options) {
  options.threads = 1;
  return options;
}

// The poses of a rung that were looked into. What is screened may come in portions.
class Ranking {
 public:
  // Refers to all of them.
  Ranking(ScaleLadder& scales, std::size_t rung, std::span<const Rival> found, const Options& options)
      : scales_(scales), frame_(scales.frame(rung)), rung_(rung), found_(found), options_(options) {}

  // Looks into what was found and into the most promising of all that was screened so far, if that is new.
  void add(std::vector<Rematch> screened);

  bool has_hope() const { return std::ranges::any_of(ranked_, is_hopeful); }

  std::vector<Rival> best_first() && { return std::move(ranked_); }

 private:
  std::vector<Transformation> most_promising() const;
  std::vector<Rival> look_into(std::span<const Transformation> candidates);

  ScaleLadder& scales_;
  CommonFrame& frame_;
  std::size_t rung_;
  std::span<const Rival> found_;
  const Options& options_;
  std::vector<Rematch> screened_;  // most promising first
  std::vector<Transformation> tried_;
  std::vector<Rival> ranked_;  // best first
};

// The first few that repeat neither an earlier one nor what was found: matching again draws proposals together, and six
// times the same pose would leave no room for the others. Of those that too little agrees with one at most, so that
// there is an answer.
std::vector<Transformation> Ranking::most_promising() const {
  std::vector<Transformation> kept;
  for (const Rematch& match : screened_) {
    if (match.agreeing < fewest_agreeing && !(found_.empty() && kept.empty())) continue;
    const auto is_repeated = [&](const Transformation& other) {
      return same_pose(match.target_from_source, other, Eigen::Vector3d::Zero(), scales_.voxel_size(rung_));
    };
    if (std::ranges::none_of(found_, is_repeated, &Rival::target_from_source) &&
        std::ranges::none_of(kept, is_repeated)) {
      kept.push_back(match.target_from_source);
    }
    if (kept.size() == static_cast<std::size_t>(options_.hypotheses.max_refined)) break;
  }
  return kept;
}

// A few iterations of the loop and a short refinement for each, then the question that the verdict asks as well: how
// well do the clouds agree at this pose?
std::vector<Rival> Ranking::look_into(std::span<const Transformation> candidates) {
  const Surface source = surface_of(frame_.source()), target = surface_of(frame_.target());
  const Options alone = in_one_thread(options_);
  // Fitted again, a proposal turns by a few degrees; the loop's first iterations do without new descriptors for that.
  frame_.describe(candidates, Look::whole, near_enough_rad);
  const std::vector<Transformation> poses =
      for_each_pose<Transformation>(frame_, candidates, [&](const Transformation& candidate) {
        const auto& descriptors = frame_.source_descriptors(candidate.linear(), Look::whole, near_enough_rad);
        const LoopOutcome loop = hybrid_loop(frame_, descriptors, candidate, first_iterations, alone);
        return settle(source, target, loop.target_from_source, scales_.voxel_size(rung_), alone);
      });
  frame_.describe(poses);
  return for_each_pose<Rival>(frame_, poses, [&](const Transformation& pose) {
    return Rival{pose, assess_pose(scales_, rung_, pose, 1)};
  });
}

void Ranking::add(std::vector<Rematch> screened) {
  std::ranges::move(screened, std::back_inserter(screened_));
  std::ranges::stable_sort(screened_, std::greater(), promise_of);
  std::vector<Transformation> candidates;
  if (tried_.empty())
    for (const Rival& pose : found_) candidates.push_back(pose.target_from_source);
  const auto is_tried = [&](const Transformation& pose) {
    return std::ranges::any_of(tried_, [&](const Transformation& other) { return other.matrix() == pose.matrix(); });
  };
  for (const Transformation& pose : most_promising()) {
    if (!is_tried(pose)) candidates.push_back(pose);
  }
  std::ranges::copy(candidates, std::back_inserter(tried_));
  std::ranges::move(look_into(candidates), std::back_inserter(ranked_));
  sort_by_quality(ranked_);
}

}  // namespace

double quality_without_free_space(const Rival& pose) {
  return pose.assessment.quality - pose.assessment.free_space_evidence;
}

bool is_hopeful(const Rival& pose) {
  return quality_without_free_space(pose) >= hopeful_quality;
}

std::vector<Rival> search_at(ScaleLadder& scales, std::size_t rung, std::span<const Rival> found, Options options,
                             StageClock& clock) {
  CommonFrame& frame = scales.frame(rung);
  options.hypotheses = how_many(scales, options.hypotheses);
  clock.start("hypotheses");
  const std::vector<Hypothesis> hypotheses = propose(frame, options);
  const FreeSpaceQuestion ask_free_space = question_of_free_space(scales);
  Screening screening(frame, hypotheses, options, ask_free_space);
  Ranking ranking(scales, rung, found, options);
  const auto rank = [&](std::vector<Rematch> matched) {
    if (ask_free_space)
      for (const Rematch& pose : matched) scales.space().note_proposal(pose.free_space);
    clock.start("ranking");
    ranking.add(std::move(matched));
  };
  clock.start("screening");
  rank(screening.most_promising([&](double share) { clock.report(share); }));
  if (screening.has_put_off() && ranking.has_hope()) {
    clock.start("screening");
    rank(screening.put_off());
  }
  return std::move(ranking).best_first();
}

}  // namespace igsp
