#include <fmt/format.h>

#include <iostream>
#include <numbers>
#include <stdexcept>

#include "dense_assignment.hpp"
#include "files/output_file.hpp"
#include "igsp/align.hpp"
#include "matching/hamming.hpp"
#include "staged_loop.hpp"
#include "tables.hpp"

namespace igsp::paper {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

constexpr const char* registration_header =
    "pair,dataset,preset,source_keypoints,target_keypoints,voxel_size,preparation_s,iteration_s,iterations,total_s,"
    "dense_iteration_s,rotation_error_deg,translation_error_m,centroid_displacement_m,right,registered,confidence,"
    "termination\n";
constexpr const char* iteration_header =
    "pair,dataset,preset,k,w_fd,w_ed,t_cd,candidate_edges,matches,correct,possible,precision,recall,"
    "precision_within_r_k,energy,edges_s,sparse_s,matrix_s,dense_s,rotation_step_deg,translation_step_m,"
    "rotation_error_deg,centroid_displacement_m,r00,r01,r02,t0,r10,r11,r12,t1,r20,r21,r22,t2\n";

struct Tables {
  std::string registrations = registration_header, iterations = iteration_header;
};

// [CPU seconds]
struct Times {
  double preparation = 0, iteration = 0, total = 0, dense_iteration = 0;
};

std::string registration_row(const Pair& pair, std::string_view preset, const Result& result, const Times& times) {
  const PoseError error = pose_error(result.target_from_source, pair.truth, centroid_of(pair.source));
  return fmt::format("{},{},{},{},{},{:.6g},{:.4g},{:.4g},{},{:.4g},{:.4g},", pair.name, pair.dataset, preset,
                     result.source.keypoints, result.target.keypoints, result.voxel_size, times.preparation,
                     times.iteration, result.iterations.size(), times.total, times.dense_iteration) +
         fmt::format("{:.6g},{:.6g},{:.6g},{:d},{:d},{:.4g},{}\n", error.rotation_rad / degree, error.translation,
                     error.centroid_displacement, result.has_estimate && is_right(error, pair), result.registered,
                     result.confidence, to_string(result.termination));
}

std::string iteration_row(const Pair& pair, std::string_view preset, const IterationRecord& record,
                          const MatchQuality& quality, const MatchQuality& within_r_k, const AssignmentCost& cost,
                          const Transformation& target_from_source) {
  const PoseError error = pose_error(target_from_source, pair.truth, centroid_of(pair.source));
  std::string row = fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.9g},", pair.name,
                                pair.dataset, preset, record.k, record.w_fd, record.w_ed, record.t_cd,
                                record.candidate_edges, record.matches, quality.correct, quality.possible,
                                quality.precision(), quality.recall(), within_r_k.precision(), record.energy) +
                    fmt::format("{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.6g},{:.6g}", cost.edges_s, cost.sparse_s,
                                cost.matrix_s, cost.dense_s, record.rotation_step_rad / degree, record.translation_step,
                                error.rotation_rad / degree, error.centroid_displacement);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) row += fmt::format(",{:.17g}", target_from_source.matrix()(i, j));
  }
  return row + "\n";
}

/// Every iteration of the run once more, with both assignments; the source stands where the iteration found it.
std::vector<AssignmentCost> costs_of(const StagedLoop& loop, const LoopOutcome& outcome, const Options& options) {
  const FeatureDistances distances =
      feature_distance_matrix(loop.source_variants(), 4, loop.target().descriptors, options.threads);
  std::vector<AssignmentCost> costs;
  Transformation before = Transformation::Identity();
  for (const IterationRecord& record : outcome.iterations) {
    Points source;
    for (const Eigen::Vector3d& point : loop.source_keypoints()) source.push_back(before * point);
    const KeypointSets keypoints{source, loop.target_keypoints(), loop.source_variants(), 4, loop.target().descriptors};
    costs.push_back(
        assignment_cost(keypoints, distances, loop.ed_scale(options), {record.w_fd, record.w_ed}, record.t_cd, true));
    before = record.target_from_source;
  }
  return costs;
}

/// The paper's answer as an initial guess for our fine registration: its released program ends with an ICP, too.
void add_refined(const Pair& pair, const StagedLoop& loop, const Transformation& initial, Times times, Tables& tables) {
  Options options = loop.options_at_scale(paper_options());
  options.refinement.enabled = true;
  const double begin = cpu_seconds();
  const Result result = align(loop.source(), loop.target(), initial, options);
  times.total += cpu_seconds() - begin;
  tables.registrations += registration_row(pair, "paper_refined", result, times);
}

void add_paper(const Pair& pair, Tables& tables) {
  const StagedLoop loop(pair, paper_options());
  const Options options = loop.options_at_scale(paper_options());
  const double begin = cpu_seconds();
  const LoopOutcome outcome = loop.run(options);
  const double loop_s = cpu_seconds() - begin;
  const std::vector<AssignmentCost> costs = costs_of(loop, outcome, options);
  Times times{loop.preparation_s(), 0, loop.preparation_s() + loop_s, 0};
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const IterationRecord& record = outcome.iterations[i];
    times.dense_iteration += (costs[i].matrix_s + costs[i].dense_s) / static_cast<double>(costs.size());
    tables.iterations += iteration_row(pair, "paper", record, quality_of(record, loop, options, pair.truth),
                                       quality_of(record, loop, options, pair.truth, 1.0), costs[i],
                                       loop.to_world(record.target_from_source));
  }
  if (!costs.empty()) times.iteration = loop_s / static_cast<double>(costs.size());
  const Result result = align(loop.source(), loop.target(), options);
  tables.registrations += registration_row(pair, "paper", result, times);
  if (result.has_estimate) add_refined(pair, loop, result.target_from_source, times, tables);
}

void add_default(const Pair& pair, Tables& tables) {
  Options options;
  options.threads = 1;
  const double begin = cpu_seconds();
  const Result result = align(pair.source, pair.target, options);
  const Times times{0, 0, cpu_seconds() - begin, 0};
  const double r_k = options.keypoints.suppression_radius * result.voxel_size;
  for (const IterationRecord& record : result.iterations) {
    const auto quality = [&](double radius) {
      return match_quality(record.correspondences, result.source_keypoints, result.target_keypoints, pair.truth,
                           radius);
    };
    tables.iterations +=
        iteration_row(pair, "default", record, quality(r_k / 3.0), quality(r_k), {}, record.target_from_source);
  }
  tables.registrations += registration_row(pair, "default", result, times);
}

}  // namespace

void write_registrations(const std::filesystem::path& pairs, const std::filesystem::path& data) {
  cli::check_writable(data / "registrations.csv");
  Tables tables;
  for (const Pair& pair : read_pairs(pairs)) {
    std::cerr << pair.name << "\n";
    add_paper(pair, tables);
    add_default(pair, tables);
  }
  cli::write_text(data / "registrations.csv", tables.registrations);
  cli::write_text(data / "iterations.csv", tables.iterations);
}

}  // namespace igsp::paper
