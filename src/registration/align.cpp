#include "igsp/align.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "core/concurrently.hpp"
#include "features/extraction.hpp"
#include "registration/exchange.hpp"
#include "registration/mirror_image.hpp"
#include "registration/reason.hpp"
#include "registration/scale_lengths.hpp"
#include "registration/search.hpp"
#include "registration/verdict.hpp"
#include "spatial/scale.hpp"
#include "spatial/unit_of_length.hpp"

namespace igsp {
namespace {

// p_target = T_world p_source, from the transformation between the centred clouds.
Transformation to_world(const Transformation& local, const Features& source, const Features& target) {
  Transformation world = local;
  world.translation() += target.origin - local.linear() * source.origin;
  return world;
}

Transformation to_local(const Transformation& world, const Features& source, const Features& target) {
  Transformation local = world;
  local.translation() = world * source.origin - target.origin;
  return local;
}

Points keypoints_in_world(const Features& features) {
  Points keypoints;
  keypoints.reserve(features.keypoints.size());
  for (const std::uint32_t i : features.keypoints) keypoints.push_back(features.points[i] + features.origin);
  return keypoints;
}

CloudSummary summary_of(const Features& features) {
  std::optional<Eigen::Vector3d> viewpoint = features.viewpoint;
  if (viewpoint) *viewpoint += features.origin;
  Points part_viewpoints;
  for (const ScannedPart& part : features.parts) part_viewpoints.push_back(part.viewpoint + features.origin);
  return {features.cloud_points, features.points.size(), features.keypoints.size(), features.stray, viewpoint,
          part_viewpoints};
}

void check_compatible(const Features& source, const Features& target) {
  if (source.voxel_size == target.voxel_size) return;
  throw InvalidArgument(
      fmt::format("source and target features were extracted with voxel_size {} and {}; both must be the same",
                  source.voxel_size, target.voxel_size));
}

StageTimings sum_of(StageTimings a, const StageTimings& b) {
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) a[i].second += b[i].second;
  return a;
}

}  // namespace

std::string_view to_string(Termination termination) {
  switch (termination) {
    case Termination::converged:
      return "converged";
    case Termination::max_iterations:
      return "max_iterations";
    case Termination::too_few_keypoints:
      return "too_few_keypoints";
    case Termination::too_few_matches:
      return "too_few_matches";
    case Termination::degenerate_matches:
      return "degenerate_matches";
  }
  return "unknown";
}

namespace {

// No scale can be chosen, nor is anything there to register: an answer, not the caller's mistake.
Result without_extent(const TrimmedCloud& source, const TrimmedCloud& target, const Options& options) {
  Result result;
  result.options = options;
  result.source.points = source.points().size();
  result.target.points = target.points().size();
  result.termination = Termination::too_few_keypoints;
  result.reason = "all points coincide in both clouds: there is nothing to register";
  return result;
}

SearchOutcome search(ScaleLadder& scales, const std::optional<Transformation>& initial, const Options& options,
                     StageClock& clock) {
  if (initial) return refine_initial(scales, *initial, options, clock);
  if (options.search == Search::direct) return direct_search(scales.frame(0), options, clock);
  return hypotheses_search(scales, options, clock);
}

Result align_in_order(const Features& source, const Features& target, bool is_exchanged,
                      const CompleteBoth& complete_both, const Transformation* initial, const Options& options,
                      const ProgressCallback& progress) {
  StageClock clock(progress);
  Result result;
  result.options = options;
  result.voxel_size = target.voxel_size;
  result.source = summary_of(source);
  result.target = summary_of(target);

  clock.start("common frame");
  ScaleLadder scales(source, target, complete_both, options, clock);
  std::optional<Transformation> local_initial;
  if (initial) local_initial = to_local(*initial, source, target);
  const SearchOutcome outcome = search(scales, local_initial, options, clock);
  const CommonFrame& scale = scales.frame(outcome.rung);
  result.loop_voxel_size = scale.target().features.voxel_size;
  result.source_keypoints = keypoints_in_world(scale.source().features);
  result.target_keypoints = keypoints_in_world(scale.target().features);
  result.source.keypoints = result.source_keypoints.size();
  result.target.keypoints = result.target_keypoints.size();
  clock.start("verdict");
  Doubts doubts = judge(scales, outcome, result);
  if (!initial && options.search == Search::hypotheses) {
    compare_with_mirror_image(source, target, complete_both, clock, doubts, result);
  }
  result.registered = result.confidence >= options.level;
  result.target_from_source = to_world(outcome.target_from_source, source, target);
  result.precision.centre += target.origin;
  if (result.runner_up) {
    result.runner_up->target_from_source = to_world(result.runner_up->target_from_source, source, target);
  }
  result.iterations = outcome.iterations;
  for (IterationRecord& record : result.iterations) {
    record.target_from_source = to_world(record.target_from_source, source, target);
  }
  if (is_exchanged) exchange_clouds(result);
  const CommonFrame& frame = scales.frame(outcome.finest_rung);
  give_reason(is_exchanged ? frame.source() : frame.target(), doubts, result);
  clock.finish();
  result.timings_s = sum_of(source.timings_s, target.timings_s);
  result.timings_s.insert(result.timings_s.end(), clock.timings().begin(), clock.timings().end());
  return result;
}

// The verdict must not depend on which cloud is called the source, and all of the search does: descriptors of a common
// frame stand in the target's axes. So the cloud of more voxels moves inside, whatever the caller calls it; of as many,
// the one whose coordinates come last.
bool is_in_order(const Features& source, const Features& target) {
  if (source.points.size() != target.points.size()) return source.points.size() > target.points.size();
  const auto before = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  return !std::ranges::lexicographical_compare(target.points, source.points, before);
}

Result align_features(const Features& source, const Features& target, const CompleteBoth& complete_both,
                      const Transformation* initial, const Options& options, const ProgressCallback& progress) {
  validate(options);
  check_compatible(source, target);
  if (is_in_order(source, target)) {
    return align_in_order(source, target, false, complete_both, initial, options, progress);
  }
  std::optional<Transformation> inverse;
  if (initial) inverse = initial->inverse();
  return align_in_order(target, source, true, complete_both, inverse ? &*inverse : nullptr, options, progress);
}

Result align_points(const TrimmedScan& source, const TrimmedScan& target, const Transformation* initial,
                    const Options& options, const ProgressCallback& progress) {
  const double extent = std::max(source.cloud.bounds().diagonal(), target.cloud.bounds().diagonal());
  if (extent == 0 && options.scale.voxel_size == 0) return without_extent(source.cloud, target.cloud, options);
  StageClock clock(progress);
  clock.start("scale");
  Options scaled = options;
  scaled.scale.voxel_size = choose_voxel_size(source.cloud, target.cloud, options.scale, options.threads);
  clock.start("voxel grid");
  Features source_features, target_features;
  const auto extract = [&](const TrimmedScan& scan, Features& features) {
    return [&](const ProgressCallback& report) {
      features = extract_features(scan, scaled, report, Described::as_voxels);
      features.timings_s.clear();  // the clock here tells of both
    };
  };
  concurrently(options.threads, progress, extract(source, source_features), extract(target, target_features));
  clock.finish();
  const CompleteBoth complete_both = [&](StageClock& at) {
    complete(scaled, at, source_features);
    complete(scaled, at, target_features);
  };
  Result result = align_features(source_features, target_features, complete_both, initial, scaled, progress);
  result.timings_s.insert(result.timings_s.begin(), clock.timings().begin(), clock.timings().end());
  return result;
}

}  // namespace

namespace {

std::optional<Transformation> guess_in_unit(const Transformation* initial, double unit) {
  if (!initial) return std::nullopt;
  Transformation scaled = *initial;
  scaled.translation() = in_unit(initial->translation(), unit, "the translation of the initial guess");
  return scaled;
}

Options options_in_unit(Options options, double unit) {
  options.scale.voxel_size /= unit;
  return options;
}

// Both clouds where single precision is at home, and the answer in the caller's unit again.
Result align_scans(const Scan& source, const Scan& target, const Transformation* initial, const Options& options,
                   const ProgressCallback& progress) {
  validate(options);
  std::optional<TrimmedScan> moving_scan, fixed_scan;
  concurrently(
      options.threads, {}, [&](const ProgressCallback&) { moving_scan.emplace(source, "source"); },
      [&](const ProgressCallback&) { fixed_scan.emplace(target, "target"); });
  const TrimmedScan &moving = *moving_scan, &fixed = *fixed_scan;
  const double unit = unit_of_length(moving.cloud.bounds(), fixed.cloud.bounds(), options.scale.voxel_size);
  if (unit == 1) return align_points(moving, fixed, initial, options, progress);
  const auto guess = guess_in_unit(initial, unit);
  Result result = align_points(moving.in_unit(unit), fixed.in_unit(unit), guess ? &*guess : nullptr,
                               options_in_unit(options, unit), progress);
  scale_lengths(result, unit);
  return result;
}

Result align_extracted(const Features& source, const Features& target, const Transformation* initial,
                       const Options& options, const ProgressCallback& progress) {
  validate(options);
  check_compatible(source, target);
  const auto local_bounds = [](const Features& features) {
    return features.points.empty() ? Bounds{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}
                                   : bounds_of(features.points, "features");
  };
  const double unit = unit_of_length(local_bounds(source), local_bounds(target), target.voxel_size);
  const CompleteBoth nothing_missing = [](StageClock&) {};
  if (unit == 1) return align_features(source, target, nothing_missing, initial, options, progress);
  Features scaled_source = source, scaled_target = target;
  scale_lengths(scaled_source, 1 / unit);
  scale_lengths(scaled_target, 1 / unit);
  const auto guess = guess_in_unit(initial, unit);
  Result result = align_features(scaled_source, scaled_target, nothing_missing, guess ? &*guess : nullptr,
                                 options_in_unit(options, unit), progress);
  scale_lengths(result, unit);
  return result;
}

}  // namespace

Result align(const Scan& source, const Scan& target, const Options& options, const ProgressCallback& progress) {
  return align_scans(source, target, nullptr, options, progress);
}

Result align(const Scan& source, const Scan& target, const Transformation& initial, const Options& options,
             const ProgressCallback& progress) {
  return align_scans(source, target, &initial, options, progress);
}

Result align(const Features& source, const Features& target, const Options& options, const ProgressCallback& progress) {
  return align_extracted(source, target, nullptr, options, progress);
}

Result align(const Features& source, const Features& target, const Transformation& initial, const Options& options,
             const ProgressCallback& progress) {
  return align_extracted(source, target, &initial, options, progress);
}

}  // namespace igsp
