#include <algorithm>
#include <array>

#include "registration/hypotheses.hpp"
#include "registration/igsp_loop.hpp"
#include "registration/point_to_plane.hpp"
#include "registration/pose_assessment.hpp"
#include "registration/search.hpp"

namespace igsp {
namespace {

// In a common frame, descriptors of the same place differ by less than about 95 bits; 10 bits of Euclidean distance are
// one voxel at the default suppression radius.
constexpr LoopSchedule::Bounds common_frame_bounds{95.0, 10.0};
constexpr int first_hybrid_k = 4;
constexpr double hybrid_fit_scale = 1.5;  // voxels

constexpr std::array<double, 6> coarse_radii{3, 3, 2, 2, 1.5, 1.5};
constexpr std::array<double, 5> fine_radii{3, 2, 1.5, 1.5, 1};
constexpr double fine_normal_radius = 1.5;    // voxels
constexpr std::size_t enough_agreeing = 15;
constexpr double enough_agreement = 0.6;

std::vector<Hypothesis> propose(CommonFrame& frame, const Options& options) {
  const PreparedCloud &source = frame.source(), &target = frame.target();
  const double v = target.features.voxel_size;
  const HypothesisOptions& h = options.hypotheses;
  const int variants = options.degrees_of_freedom == 4 ? 2 : 4;
  const auto candidates = feature_candidates({source.keypoints, source.features.frames, source.features.descriptors},
                                             {target.keypoints, target.features.frames, target.features.descriptors},
                                             variants, h.candidates_per_keypoint, h.max_candidates, options.threads);
  const ConsistencyOptions consistency{h.length_tolerance * v, h.min_length * v, h.max_frame_angle_rad};
  const auto graph =
      consistency_graph(candidates, source.keypoints, target.keypoints, consistency, options.threads);
  return propose_hypotheses(candidates, graph, source.keypoints, target.keypoints, v, options);
}

// Matches every proposal again in its common frame and keeps those with most agreeing matches.
std::vector<Rematch> screen(CommonFrame& frame, std::span<const Hypothesis> hypotheses, const Options& options,
                            StageClock& clock) {
  std::vector<Rematch> screened;
  for (const Hypothesis& hypothesis : hypotheses) {
    clock.report(static_cast<double>(screened.size()) / static_cast<double>(hypotheses.size()));
    Rematch match = rematch(frame, hypothesis.target_from_source, options.degrees_of_freedom);
    const bool clear = match.agreeing >= enough_agreeing &&
                       static_cast<double>(match.agreeing) >= enough_agreement * match.matches.size();
    screened.push_back(std::move(match));
    if (clear) break;
  }
  std::stable_sort(screened.begin(), screened.end(),
                   [](const Rematch& a, const Rematch& b) { return a.agreeing > b.agreeing; });
  if (screened.size() > static_cast<std::size_t>(options.hypotheses.max_refined)) {
    screened.resize(options.hypotheses.max_refined);
  }
  return screened;
}

LoopOutcome hybrid_loop(CommonFrame& frame, const Transformation& initial, int iterations, const Options& options) {
  const LoopInput input{frame.source().keypoints,   frame.target().keypoints,
                        frame.source_descriptors(initial.linear()), 1,
                        frame.target_descriptors(), frame.target().features.voxel_size};
  return igsp_loop(input, initial, {first_hybrid_k, iterations, hybrid_fit_scale, common_frame_bounds}, options);
}

// A short refinement on the voxel centroids, before hypotheses are compared.
Transformation settle(Surface& source, Surface& target, const Transformation& initial, double voxel_size,
                      const Options& options) {
  return refine_point_to_plane(source, target, initial, {800, coarse_radii, 0, voxel_size, options.degrees_of_freedom});
}

// Down to the noise of the scanner, on the finer voxels.
Transformation refine(const CommonFrame& frame, const Transformation& initial, const Options& options) {
  const Features &source = frame.source().features, &target = frame.target().features;
  const double v = target.voxel_size;
  Surface fine_source(source.fine_points, PointGrid(source.fine_points, v), fine_normal_radius * v);
  Surface fine_target(target.fine_points, PointGrid(target.fine_points, v), fine_normal_radius * v);
  return refine_point_to_plane(fine_source, fine_target, initial,
                               {4000, fine_radii, 10, v, options.degrees_of_freedom});
}

}  // namespace

SearchOutcome hypotheses_search(CommonFrame& frame, const Options& options, StageClock& clock) {
  SearchOutcome outcome;
  clock.start("hypotheses");
  const std::vector<Hypothesis> hypotheses = propose(frame, options);
  clock.start("screening");
  const std::vector<Rematch> screened = screen(frame, hypotheses, options, clock);
  if (screened.empty()) return outcome;

  clock.start("ranking");
  const double v = frame.target().features.voxel_size;
  Surface source(frame.source().features.points, frame.source().grid, frame.source().features.normals);
  Surface target(frame.target().features.points, frame.target().grid, frame.target().features.normals);
  double best_score = -1;
  for (const Rematch& candidate : screened) {
    clock.report(0.5);
    const LoopOutcome loop = hybrid_loop(frame, candidate.target_from_source, 3, options);
    const Transformation pose = settle(source, target, loop.target_from_source, v, options);
    const double score = ranking_score(frame, pose);
    if (score > best_score) {
      best_score = score;
      std::swap(outcome.target_from_source, outcome.rivals.emplace_back(pose));
      if (!outcome.has_estimate) outcome.rivals.clear();
      outcome.has_estimate = true;
    } else {
      outcome.rivals.push_back(pose);
    }
  }

  clock.start("loop");
  LoopOutcome loop = hybrid_loop(frame, outcome.target_from_source, 20, options);
  outcome.termination = loop.termination;
  outcome.iterations = std::move(loop.iterations);
  if (loop.has_estimate) outcome.target_from_source = loop.target_from_source;

  if (options.refinement.enabled) {
    clock.start("refinement");
    outcome.target_from_source = refine(frame, outcome.target_from_source, options);
  }
  return outcome;
}

}  // namespace igsp
