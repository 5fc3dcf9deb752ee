#include "registration/screening.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>

#include "registration/each_pose.hpp"
#include "registration/free_space.hpp"
#include "registration/pose_assessment.hpp"

namespace igsp {
namespace {

constexpr std::size_t enough_agreeing = 15;
constexpr double enough_agreement = 0.6;
constexpr double rival_inliers = 0.5;  // of the winner's
constexpr std::size_t without_first_look = 3;
constexpr std::size_t least_promising = 3;
constexpr double promising_share = 0.25;

double evidence_of(const Rematch& match) {
  return free_space_evidence(match.free_space, usual_rarity, 1);
}

bool is_clear(const Rematch& match) {
  return evidence_of(match) >= 0 && match.agreeing >= enough_agreeing &&
         static_cast<double>(match.agreeing) >= enough_agreement * static_cast<double>(match.matches.size());
}

// The pose with the most matches has the promise of them; where free space can tell like places apart, the better of
// that and the hypothesis where it is.
Rematch matched_again(CommonFrame& frame, const Transformation& pose, int degrees_of_freedom,
                      const FreeSpaceQuestion& ask_free_space, Look look) {
  Rematch by_vote = rematch(frame, pose, degrees_of_freedom, 1, look);
  if (!ask_free_space) return by_vote;
  by_vote.free_space = ask_free_space(by_vote.target_from_source);
  Rematch in_place = fit_in_place(frame, pose, by_vote.matches, degrees_of_freedom);
  const double v = frame.target().features.voxel_size;
  if (same_pose(in_place.target_from_source, by_vote.target_from_source, Eigen::Vector3d::Zero(), v)) return by_vote;
  in_place.free_space = ask_free_space(in_place.target_from_source);
  return promise_of(in_place) > promise_of(by_vote) ? in_place : by_vote;
}

std::vector<Rematch> matched_again(CommonFrame& frame, std::span<const Hypothesis> hypotheses, int degrees_of_freedom,
                                   const FreeSpaceQuestion& ask_free_space, Look look) {
  std::vector<Transformation> poses;
  for (const Hypothesis& hypothesis : hypotheses) poses.push_back(hypothesis.target_from_source);
  frame.describe(poses, look);
  return for_each_pose<Rematch>(frame, poses, [&](const Transformation& pose) {
    return matched_again(frame, pose, degrees_of_freedom, ask_free_space, look);
  });
}

}  // namespace

double promise_of(const Rematch& match) {
  return matches_weight * std::log10(static_cast<double>(match.agreeing) + 1) + evidence_of(match);
}

Screening::Screening(CommonFrame& frame, std::span<const Hypothesis> hypotheses, const Options& options,
                     const FreeSpaceQuestion& ask_free_space)
    : frame_(frame),
      hypotheses_(hypotheses),
      degrees_of_freedom_(options.degrees_of_freedom),
      ask_free_space_(ask_free_space) {}

std::vector<Rematch> Screening::match(std::span<const Hypothesis> batch) {
  std::vector<Hypothesis> rivals;
  std::ranges::copy_if(batch, std::back_inserter(rivals), [&](const Hypothesis& hypothesis) {
    return static_cast<double>(hypothesis.inliers) >= rival_inliers * static_cast<double>(winner_inliers_);
  });
  std::vector<Rematch> found = matched_again(frame_, rivals, degrees_of_freedom_, ask_free_space_, Look::whole);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (is_clear(found[i])) winner_inliers_ = std::max(winner_inliers_, rivals[i].inliers);
  }
  return found;
}

std::vector<Hypothesis> Screening::best_at_first_look(std::span<const Hypothesis> others) {
  const std::vector<Rematch> seen = matched_again(frame_, others, degrees_of_freedom_, ask_free_space_, Look::first);
  std::vector<std::size_t> order(others.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return promise_of(seen[i]); });
  const auto share = static_cast<std::size_t>(promising_share * static_cast<double>(others.size()));
  const std::size_t kept = std::min(others.size(), std::max(least_promising, share));
  std::vector<Hypothesis> best;
  for (std::size_t i = 0; i < order.size(); ++i) (i < kept ? best : put_off_).push_back(others[order[i]]);
  return best;
}

std::vector<Rematch> Screening::most_promising(const std::function<void(double)>& tick) {
  std::vector<Rematch> matched;
  const auto add = [&](std::span<const Hypothesis> batch) {
    std::ranges::move(match(batch), std::back_inserter(matched));
  };
  // In batches that grow, for the winner is mostly among the first.
  for (std::size_t begin = 0, size = 1; begin < hypotheses_.size(); begin += size, size *= 2) {
    tick(static_cast<double>(begin) / static_cast<double>(hypotheses_.size()));
    if (begin >= without_first_look && winner_inliers_ == 0 && frame_.first_look_step() > 1) {
      add(best_at_first_look(hypotheses_.subspan(begin)));
      break;
    }
    add(hypotheses_.subspan(begin, std::min(size, hypotheses_.size() - begin)));
  }
  return matched;
}

std::vector<Rematch> Screening::put_off() {
  return match(std::exchange(put_off_, {}));
}

}  // namespace igsp
