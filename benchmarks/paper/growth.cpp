#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>

#include "dense_assignment.hpp"
#include "files/output_file.hpp"
#include "igsp/simulation.hpp"
#include "matching/hamming.hpp"
#include "staged_loop.hpp"
#include "tables.hpp"

namespace igsp::paper {
namespace {

constexpr std::array<std::size_t, 6> sizes{500, 1000, 2000, 5000, 10000, 20000};
constexpr std::array<int, 2> measured_iterations{0, 4};  // by features alone, and where both distances count
constexpr double longest_dense_s = 100.0;

Options park_options() {
  Options options = paper_options();
  options.scale.target_points = 400'000;
  options.keypoints.suppression_radius = 2.0;
  options.keypoints.min_curvature = 0.001;
  return options;
}

/// Two scans of a park, so fine that 20,000 keypoints are there.
StagedLoop park() {
  SimulationOptions scene;
  scene.points = 1'500'000;
  scene.station_distance = 8.0;
  scene.seed = 1;
  std::vector<SimulatedScan> scans = simulate("park", scene);
  Pair pair;
  pair.source = std::move(scans[1].points);
  pair.target = std::move(scans[0].points);
  return StagedLoop(pair, park_options());
}

/// The strongest keypoints: extract_features sorts them by curvature.
Features strongest(Features features, std::size_t count) {
  features.keypoints.resize(std::min(count, features.keypoints.size()));
  features.frames.resize(features.keypoints.size());
  features.descriptors.resize(features.keypoints.size());
  return features;
}

/// Iteration k of a run, once more with both assignments.
AssignmentCost cost_at(const StagedLoop& loop, const LoopOutcome& outcome, int k, const FeatureDistances& distances,
                       const Options& options, bool dense) {
  const Transformation before = k == 0 ? Transformation::Identity() : outcome.iterations[k - 1].target_from_source;
  Points source;
  for (const Eigen::Vector3d& point : loop.source_keypoints()) source.push_back(before * point);
  const KeypointSets keypoints{source, loop.target_keypoints(), loop.source_variants(), 4, loop.target().descriptors};
  const IterationRecord& record = outcome.iterations[k];
  return assignment_cost(keypoints, distances, loop.ed_scale(options), {record.w_fd, record.w_ed}, record.t_cd, dense);
}

std::string row(std::size_t size, const StagedLoop& loop, const IterationRecord& record, const AssignmentCost& cost,
                bool dense) {
  return fmt::format("{},{},{},{},{:.6g},{},{:.4g},{:.4g},{},{}\n", size, loop.source_keypoints().size(),
                     loop.target_keypoints().size(), record.k, record.t_cd, cost.edges, cost.edges_s, cost.sparse_s,
                     dense ? fmt::format("{:.4g}", cost.matrix_s) : "",
                     dense ? fmt::format("{:.4g}", cost.dense_s) : "");
}

}  // namespace

void write_growth(const std::filesystem::path& data) {
  cli::check_writable(data / "growth.csv");
  const StagedLoop all = park();
  std::cerr << fmt::format("{} and {} keypoints\n", all.source_keypoints().size(), all.target_keypoints().size());
  Options options = all.options_at_scale(park_options());
  options.convergence.max_iterations = measured_iterations.back() + 1;
  std::string table =
      "keypoints,source_keypoints,target_keypoints,k,t_cd,candidate_edges,edges_s,sparse_s,matrix_s,dense_s\n";
  std::array<double, measured_iterations.size()> dense_s{};  // of the size before, or what it would have been
  std::size_t size_before = sizes.front();
  for (const std::size_t size : sizes) {
    const StagedLoop loop(strongest(all.source(), size), strongest(all.target(), size));
    const LoopOutcome outcome = loop.run(options);
    const FeatureDistances distances =
        feature_distance_matrix(loop.source_variants(), 4, loop.target().descriptors, options.threads);
    for (std::size_t i = 0; i < measured_iterations.size(); ++i) {
      const int k = measured_iterations[i];
      if (static_cast<std::size_t>(k) >= outcome.iterations.size()) continue;
      dense_s[i] *= std::pow(static_cast<double>(size) / static_cast<double>(size_before), 3);
      const bool dense = dense_s[i] < longest_dense_s;
      const AssignmentCost cost = cost_at(loop, outcome, k, distances, options, dense);
      if (dense) dense_s[i] = cost.dense_s;
      table += row(size, loop, outcome.iterations[k], cost, dense);
      std::cerr << fmt::format("{} keypoints, k = {}: {} edges, sparse {:.3g} s, dense {:.3g} s\n", size, k, cost.edges,
                               cost.edges_s + cost.sparse_s, cost.matrix_s + cost.dense_s);
    }
    size_before = size;
  }
  cli::write_text(data / "growth.csv", table);
}

}  // namespace igsp::paper
