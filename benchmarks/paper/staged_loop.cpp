#include "staged_loop.hpp"

#include <numbers>

#include "features/bsc.hpp"
#include "igsp/align.hpp"
#include "spatial/scale.hpp"

namespace igsp::paper {
namespace {

constexpr int variants = 4;

Points keypoints_of(const Features& features) {
  Points keypoints;
  for (const std::uint32_t i : features.keypoints) keypoints.push_back(features.points[i]);
  return keypoints;
}

}  // namespace

Options paper_options() {
  Options options = preset("paper");
  options.threads = 1;
  return options;
}

StagedLoop::StagedLoop(const Pair& pair, const Options& options) {
  const double begin = cpu_seconds();
  Options scaled = options;
  scaled.scale.voxel_size = choose_voxel_size(pair.source, pair.target, options.scale);
  source_ = extract_features(pair.source, scaled);
  target_ = extract_features(pair.target, scaled);
  prepare();
  preparation_s_ = cpu_seconds() - begin;
}

StagedLoop::StagedLoop(Features source, Features target) : source_(std::move(source)), target_(std::move(target)) {
  prepare();
}

void StagedLoop::prepare() {
  source_keypoints_ = keypoints_of(source_);
  target_keypoints_ = keypoints_of(target_);
  source_variants_ = sign_variants(source_.descriptors, variants);
}

LoopOutcome StagedLoop::run(const Options& options) const {
  const LoopInput input{source_keypoints_, target_keypoints_,   source_variants_,
                        variants,          target_.descriptors, target_.voxel_size};
  LoopSchedule schedule;
  schedule.max_iterations = options.convergence.max_iterations;
  return igsp_loop(input, Transformation::Identity(), schedule, options);
}

Options StagedLoop::options_at_scale(Options options) const {
  options.scale.voxel_size = target_.voxel_size;
  return options;
}

double StagedLoop::ed_scale(const Options& options) const {
  return options.energy.distance_scale / (options.keypoints.suppression_radius * target_.voxel_size);
}

Transformation StagedLoop::to_world(const Transformation& local) const {
  Transformation world = local;
  world.translation() += target_.origin - local.linear() * source_.origin;
  return world;
}

MatchQuality quality_of(const IterationRecord& record, const StagedLoop& loop, const Options& options,
                        const Transformation& truth, double share) {
  Transformation local = truth;
  local.translation() = truth * loop.source().origin - loop.target().origin;
  const double radius = share * options.keypoints.suppression_radius * loop.target().voxel_size;
  return match_quality(record.correspondences, loop.source_keypoints(), loop.target_keypoints(), local, radius);
}

Eigen::Vector3d centroid_of(PointView points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

bool is_right(const PoseError& error, const Pair& pair) {
  return error.rotation_rad * 180.0 / std::numbers::pi < pair.max_rotation_error_deg &&
         error.centroid_displacement < pair.max_displacement;
}

}  // namespace igsp::paper
