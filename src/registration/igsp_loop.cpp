#include "registration/igsp_loop.hpp"

#include <array>
#include <chrono>

#include "estimation/robust_fit.hpp"
#include "igsp/evaluation.hpp"
#include "matching/energy.hpp"

namespace igsp {
namespace {

Points transformed(PointView points, const Transformation& transformation) {
  Points result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result[i] = transformation * points[i];
  return result;
}

Eigen::Vector3d centroid_of(PointView points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

double threshold_at(int k, const EnergyWeights& weights, const KeypointSets& keypoints,
                    std::span<const Correspondence> matched, double ed_scale, double previous,
                    const LoopSchedule& schedule, const Options& options) {
  if (schedule.bounds) return weights.fd * schedule.bounds->fd + weights.ed * schedule.bounds->ed;
  if (k == 0) return initial_threshold(feature_distance_spread(keypoints, options.threads), options.energy);
  if (k == 1 && options.energy.threshold_rule == ThresholdRule::released) {
    return initial_threshold(compound_distance_spread(keypoints, ed_scale, weights, options.threads), options.energy);
  }
  return next_threshold(matched, ed_scale, weights, previous, options.energy);
}

std::optional<Transformation> fit_step(std::span<const Correspondence> matched, const KeypointSets& keypoints,
                                       double fit_scale, int degrees_of_freedom) {
  std::vector<PointPair> pairs;
  for (const Correspondence& c : matched) pairs.push_back({keypoints.source[c.source], keypoints.target[c.target]});
  if (fit_scale == 0) return rigid_fit(pairs, degrees_of_freedom);  // Eq. 9
  const std::array<double, 3> scales{fit_scale, fit_scale, fit_scale};
  return robust_fit(pairs, Transformation::Identity(), scales, degrees_of_freedom);
}

}  // namespace

LoopOutcome igsp_loop(const LoopInput& input, const Transformation& initial, const LoopSchedule& schedule,
                      const Options& options, const std::function<void(int)>& tick) {
  LoopOutcome outcome;
  outcome.target_from_source = initial;
  if (input.source_keypoints.size() < 3 || input.target_keypoints.size() < 3) {
    outcome.termination = Termination::too_few_keypoints;
    return outcome;
  }
  Points source = transformed(input.source_keypoints, initial);
  const KeypointSets keypoints{source, input.target_keypoints, input.source_variants, input.variants,
                               input.target_descriptors};
  const double ed_scale =
      options.energy.distance_scale / (options.keypoints.suppression_radius * input.voxel_size);  // s_ed, Eq. 3
  std::vector<Correspondence> matched;
  double threshold = 0;

  for (int k = schedule.first_k; k < schedule.first_k + schedule.max_iterations; ++k) {
    if (tick) tick(k - schedule.first_k);
    const auto begin = std::chrono::steady_clock::now();
    const EnergyWeights weights = energy_weights(k, options.energy.weight_changing_rate);              // Eq. 7
    threshold = threshold_at(k, weights, keypoints, matched, ed_scale, threshold, schedule, options);  // Eq. 11
    const auto edges = candidate_edges(keypoints, ed_scale, weights, threshold, options.threads);      // Eq. 2-5
    const Assignment assignment =
        solve_assignment(source.size(), input.target_keypoints.size(), edges, to_assignment_units(threshold));  // Eq. 8
    matched = correspondences_of(assignment, keypoints);
    const auto step = fit_step(matched, keypoints, schedule.fit_scale * input.voxel_size, options.degrees_of_freedom);

    IterationRecord record;
    record.k = k;
    record.w_fd = weights.fd;
    record.w_ed = weights.ed;
    record.t_cd = threshold;
    record.candidate_edges = edges.size();
    record.matches = matched.size();
    record.energy = matching_energy(assignment, keypoints, threshold);  // Eq. 1
    for (const Correspondence& c : matched) record.correspondences.push_back({c.source, c.target});
    if (step) {
      const Eigen::Vector3d centroid = centroid_of(source);
      record.rotation_step_rad = rotation_error_rad(step->linear(), Eigen::Matrix3d::Identity());
      record.translation_step = (*step * centroid - centroid).norm();
      for (Eigen::Vector3d& point : source) point = *step * point;
      outcome.target_from_source = *step * outcome.target_from_source;
      outcome.has_estimate = true;
      update_distances(matched, keypoints);  // Eq. 11 wants residuals after the step
    }
    record.target_from_source = outcome.target_from_source;
    record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    outcome.iterations.push_back(record);

    if (!step) {
      outcome.termination = matched.size() < 3 ? Termination::too_few_matches : Termination::degenerate_matches;
      return outcome;
    }
    if (record.rotation_step_rad < options.convergence.rotation_tolerance_rad &&
        record.translation_step < options.convergence.translation_tolerance * input.voxel_size) {
      outcome.termination = Termination::converged;
      return outcome;
    }
  }
  return outcome;
}

}  // namespace igsp
