#include "registration/screening.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "registration/each_pose.hpp"
#include "registration/free_space.hpp"
#include "registration/pose_assessment.hpp"

namespace igsp {
namespace {

constexpr std::size_t enough_agreeing = 15;
constexpr double enough_agreement = 0.6;
constexpr double rival_inliers = 0.5;  // of the winner's

double evidence_of(const Rematch& match) {
  return free_space_evidence(match.free_space, usual_rarity, 1);
}

bool is_clear(const Rematch& match) {
  return evidence_of(match) >= 0 && match.agreeing >= enough_agreeing &&
         static_cast<double>(match.agreeing) >= enough_agreement * static_cast<double>(match.matches.size());
}

// What the quality of a pose has of both, in decades.
double promise_of(const Rematch& match) {
  return matches_weight * std::log10(static_cast<double>(match.agreeing) + 1) + evidence_of(match);
}

// The pose with the most matches has the promise of them; where free space can tell like places apart, the better of
// that and the hypothesis where it is.
Rematch matched_again(CommonFrame& frame, const Transformation& pose, int degrees_of_freedom,
                      const FreeSpaceQuestion& ask_free_space) {
  Rematch by_vote = rematch(frame, pose, degrees_of_freedom, 1);
  if (!ask_free_space) return by_vote;
  by_vote.free_space = ask_free_space(by_vote.target_from_source);
  Rematch in_place = fit_in_place(frame, pose, by_vote.matches, degrees_of_freedom);
  const double v = frame.target().features.voxel_size;
  if (same_pose(in_place.target_from_source, by_vote.target_from_source, Eigen::Vector3d::Zero(), v)) return by_vote;
  in_place.free_space = ask_free_space(in_place.target_from_source);
  return promise_of(in_place) > promise_of(by_vote) ? in_place : by_vote;
}

std::vector<Rematch> matched_again(CommonFrame& frame, std::span<const Hypothesis> batch, int degrees_of_freedom,
                                   const FreeSpaceQuestion& ask_free_space) {
  std::vector<Transformation> poses;
  for (const Hypothesis& hypothesis : batch) poses.push_back(hypothesis.target_from_source);
  return look_into_each<Rematch>(frame, poses, [&](const Transformation& pose) {
    return matched_again(frame, pose, degrees_of_freedom, ask_free_space);
  });
}

}  // namespace

std::vector<Rematch> screen(CommonFrame& frame, std::span<const Hypothesis> hypotheses, const Options& options,
                            const FreeSpaceQuestion& ask_free_space, const std::function<void(double)>& tick) {
  std::vector<Rematch> matched;
  std::size_t winner_inliers = 0;
  const auto could_rival = [&](const Hypothesis& hypothesis) {
    return static_cast<double>(hypothesis.inliers) >= rival_inliers * static_cast<double>(winner_inliers);
  };
  // In batches that grow, for the winner is mostly among the first.
  for (std::size_t begin = 0, size = 1; begin < hypotheses.size(); begin += size, size *= 2) {
    tick(static_cast<double>(begin) / static_cast<double>(hypotheses.size()));
    std::vector<Hypothesis> batch;
    std::ranges::copy_if(hypotheses.subspan(begin, std::min(size, hypotheses.size() - begin)),
                         std::back_inserter(batch), could_rival);
    std::vector<Rematch> found = matched_again(frame, batch, options.degrees_of_freedom, ask_free_space);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (is_clear(found[i])) winner_inliers = std::max(winner_inliers, batch[i].inliers);
      matched.push_back(std::move(found[i]));
    }
  }
  std::ranges::stable_sort(matched, std::greater(), promise_of);
  return matched;
}

}  // namespace igsp
