#include "registration/exchange.hpp"

#include <utility>

#include "registration/precision.hpp"

namespace igsp {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// In all of these every field stands by name: one that is added does not build until someone has asked which cloud it
// belongs to.

void exchange(IterationRecord& record) {
  auto& [k, w_fd, w_ed, t_cd, candidate_edges, matches, energy, rotation_step_rad, translation_step, seconds,
         target_from_source, correspondences] = record;
  target_from_source = target_from_source.inverse();
  for (auto& [source, target] : correspondences) std::swap(source, target);
}

// From small motions in the old target's frame to the same in the new one's. They are applied on the other side of the
// inverse, so their sign turns, which neither a covariance nor a direction has.
void exchange(Precision& precision, const Transformation& target_from_source) {
  auto& [inlier_rmse, centre, information, covariance, scale, scale_sigma, free_directions] = precision;
  centre = target_from_source * centre;
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = target_from_source.linear();
  turn.bottomRightCorner<3, 3>() = target_from_source.linear();
  information = (turn * information * turn.transpose()).eval();
  covariance = (turn * covariance * turn.transpose()).eval();
  scale_sigma /= scale * scale;
  scale = 1 / scale;
  for (FreeDirection& direction : free_directions) {
    direction.motion = (turn * direction.motion).eval();
    direction.description = describe_motion(direction.motion);
  }
}

void exchange(Evidence& evidence) {
  auto& [mutual_matches, agreeing_matches, contact_share, quality, rival_odds, free_space, voxel_size] = evidence;
  std::swap(free_space.source, free_space.target);
}

void exchange(RunnerUp& runner_up) {
  auto& [target_from_source, share] = runner_up;
  target_from_source = target_from_source.inverse();
}

}  // namespace

void exchange_clouds(Result& result) {
  auto& [registered, confidence, reason, termination, target_from_source, has_estimate, overlap_source, overlap_target,
         evidence, runner_up, precision, rmse, voxel_size, loop_voxel_size, source, target, source_keypoints,
         target_keypoints, iterations, timings_s, options] = result;
  target_from_source = target_from_source.inverse();
  std::swap(overlap_source, overlap_target);
  exchange(evidence);
  if (runner_up) exchange(*runner_up);
  exchange(precision, target_from_source);
  std::swap(source, target);
  std::swap(source_keypoints, target_keypoints);
  for (IterationRecord& record : iterations) exchange(record);
}

}  // namespace igsp
