#include "registration/scale_lengths.hpp"

namespace igsp {
namespace {

// In all of these every field stands by name: one that is added does not build until someone has asked whether it is a
// length.

void scale(Transformation& transformation, double factor) {
  transformation.translation() *= factor;
}

void scale(IterationRecord& record, double factor) {
  auto& [k, w_fd, w_ed, t_cd, candidate_edges, matches, energy, rotation_step_rad, translation_step, seconds,
         target_from_source, correspondences] = record;
  translation_step *= factor;
  scale(target_from_source, factor);
}

void scale(CloudSummary& summary, double factor) {
  auto& [points, voxels, keypoints, stray, viewpoint, part_viewpoints] = summary;
  if (viewpoint) *viewpoint *= factor;
  for (Eigen::Vector3d& place : part_viewpoints) place *= factor;
}

void scale(Precision& precision, double factor) {
  auto& [inlier_rmse, centre, information, covariance, scale, scale_sigma, free_directions] = precision;
  inlier_rmse *= factor;
  centre *= factor;
  // Rotations have no unit; directions are relative to the size of the scene.
  information.topRightCorner<3, 3>() /= factor;
  information.bottomLeftCorner<3, 3>() /= factor;
  information.bottomRightCorner<3, 3>() /= factor * factor;
  covariance.topRightCorner<3, 3>() *= factor;
  covariance.bottomLeftCorner<3, 3>() *= factor;
  covariance.bottomRightCorner<3, 3>() *= factor * factor;
}

void scale(RunnerUp& runner_up, double factor) {
  auto& [target_from_source, share] = runner_up;
  scale(target_from_source, factor);
}

}  // namespace

void scale_lengths(Result& result, double factor) {
  auto& [registered, confidence, reason, termination, target_from_source, has_estimate, overlap_source, overlap_target,
         evidence, runner_up, precision, rmse, voxel_size, loop_voxel_size, source, target, source_keypoints,
         target_keypoints, iterations, timings_s, options] = result;
  scale(target_from_source, factor);
  if (runner_up) scale(*runner_up, factor);
  scale(precision, factor);
  rmse *= factor;
  evidence.voxel_size *= factor;
  voxel_size *= factor;
  loop_voxel_size *= factor;
  scale(source, factor);
  scale(target, factor);
  for (Eigen::Vector3d& point : source_keypoints) point *= factor;
  for (Eigen::Vector3d& point : target_keypoints) point *= factor;
  for (IterationRecord& record : iterations) scale(record, factor);
  options.scale.voxel_size *= factor;
}

}  // namespace igsp
