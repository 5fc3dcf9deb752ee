#include "evaluate/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/rigid_fit.hpp"
#include "igsp/errors.hpp"
#include "igsp/evaluation.hpp"

namespace igsp::cli {
namespace {

constexpr double same_time = 1e-3;

using PosePair = std::pair<Transformation, Transformation>;  // estimate, truth

std::vector<PosePair> common_poses(std::vector<io::TimedPose> estimate, std::vector<io::TimedPose> truth) {
  std::ranges::stable_sort(estimate, {}, &io::TimedPose::time);
  std::ranges::stable_sort(truth, {}, &io::TimedPose::time);
  std::vector<PosePair> pairs;
  for (std::size_t i = 0, j = 0; i < estimate.size() && j < truth.size();) {
    const double later = estimate[i].time - truth[j].time;
    if (std::abs(later) <= same_time) {
      pairs.emplace_back(estimate[i++].pose, truth[j++].pose);
    } else {
      ++(later > 0 ? j : i);
    }
  }
  return pairs;
}

ErrorRange range_of(const std::vector<double>& errors) {
  ErrorRange range;
  for (const double error : errors) {
    range.mean += error / static_cast<double>(errors.size());
    range.max = std::max(range.max, error);
  }
  return range;
}

// Where all positions lie on a line, or are two, no motion is the best one: that of the first pose is taken.
Transformation truth_from_estimate(const std::vector<PosePair>& pairs) {
  std::vector<PointPair> positions;
  for (const auto& [estimate, truth] : pairs) positions.push_back({estimate.translation(), truth.translation()});
  return rigid_fit(positions).value_or(pairs[0].second * pairs[0].first.inverse());
}

}  // namespace

TrajectoryError trajectory_error(const std::vector<io::TimedPose>& estimate, const std::vector<io::TimedPose>& truth) {
  const std::vector<PosePair> pairs = common_poses(estimate, truth);
  if (pairs.size() < 2) {
    throw InvalidArgument(fmt::format("{} of {} and {} poses are of the same time; at least two are needed",
                                      pairs.size(), estimate.size(), truth.size()));
  }
  std::vector<double> rotations, translations, positions;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const Transformation step = pairs[i - 1].first.inverse() * pairs[i].first,
                         true_step = pairs[i - 1].second.inverse() * pairs[i].second;
    rotations.push_back(rotation_error_rad(step.linear(), true_step.linear()));
    translations.push_back((true_step.inverse() * step.translation()).norm());
  }
  const Transformation best = truth_from_estimate(pairs);
  double squares = 0;
  for (const auto& [estimated, true_pose] : pairs) {
    positions.push_back((best * estimated.translation() - true_pose.translation()).norm());
    squares += positions.back() * positions.back();
  }
  return {pairs.size(), range_of(rotations), range_of(translations), range_of(positions),
          std::sqrt(squares / static_cast<double>(pairs.size()))};
}

}  // namespace igsp::cli
