#include "benchmark/judgement.hpp"

#include <numbers>

#include "simulation/random.hpp"

namespace igsp::cli {
namespace {

// FNV-1a: a stream of random numbers per name, the same with every standard library.
std::uint64_t hash(std::string_view text) {
  std::uint64_t value = 0xcbf29ce484222325u;
  for (const unsigned char c : text) value = (value ^ c) * 0x100000001b3u;
  return value;
}

}  // namespace

Transformation scramble(std::uint64_t seed, std::string_view case_name, const Eigen::Vector3d& centre,
                        double diagonal) {
  simulation::Random random(seed, hash(case_name));
  Transformation motion = Transformation::Identity();
  motion.linear() = random.rotation();
  motion.translation() = centre - motion.linear() * centre + 3.0 * diagonal * random.direction();
  return motion;
}

Judgement judge_case(const BenchmarkCase& one, const Transformation& truth, const Eigen::Vector3d& source_centroid,
                     const Transformation& scrambled_from_source, const Result& result) {
  if (one.truth == Truth::unknown) return {};
  if (one.truth == Truth::none) return {.success = !result.registered, .error = {}};
  if (!result.has_estimate) return {.success = false, .error = {}};
  const Transformation target_from_source = result.target_from_source * scrambled_from_source;
  const PoseError error = pose_error(target_from_source, truth, source_centroid);
  const bool success = error.rotation_rad * 180.0 / std::numbers::pi < one.max_rotation_error_deg &&
                       error.centroid_displacement < one.max_displacement;
  return {.success = success, .error = error};
}

std::optional<MatchQuality> judge_matches(const Result& result, const Transformation& truth) {
  if (result.iterations.empty()) return std::nullopt;
  const double radius = result.options.keypoints.suppression_radius / 3.0 * result.loop_voxel_size;
  return match_quality(result.iterations.back().correspondences, result.source_keypoints, result.target_keypoints,
                       truth, radius);
}

}  // namespace igsp::cli
