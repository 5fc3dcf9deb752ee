// Simulated pairs of known truth, registered with the default preset: one row of CSV per answer, for reliability.py.
//   igsp_calibrate --pairs 800 --seed 1 --jobs 2 [--viewpoints] --out calibration.csv
// The rows depend on --seed alone. A pair gives one row, and a second one ("runner_up") when a wrong hypothesis was
// looked into: that one refined to the end, as if the right one had not been found.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <fstream>
#include <iostream>
#include <thread>

#include "igsp/align.hpp"
#include "igsp/evaluation.hpp"
#include "pairs.hpp"
#include "simulation/overlap.hpp"
#include "spatial/scale.hpp"

namespace igsp::calibration {
namespace {

constexpr double same_angle_rad = 5.0 * std::numbers::pi / 180.0;
constexpr double same_displacement = 3.0;  // voxels
constexpr double overlap_radius = 2.0;     // voxels

// [rad], [voxels]
struct Error {
  double rotation_rad, displacement;
  bool is_same_pose() const { return rotation_rad < same_angle_rad && displacement < same_displacement; }
};

Error error_of(const Result& result, const Transformation& truth, const Pair& pair) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : pair.source.points) centroid += point;
  centroid /= static_cast<double>(pair.source.points.size());
  const PoseError error = pose_error(result.target_from_source, truth, centroid);
  return {error.rotation_rad, error.centroid_displacement / result.voxel_size};
}

bool is_right(const Pair& pair, const Result& result) {
  return pair.recipe.is_one_scene() && result.has_estimate && error_of(result, pair.truth, pair).is_same_pose();
}

double overlap_of(const Pair& pair, double voxel_size) {
  if (!pair.recipe.is_one_scene()) return 0;
  return std::min(simulation::overlap_of(pair.source, pair.target, overlap_radius * voxel_size),
                  simulation::overlap_of(pair.target, pair.source, overlap_radius * voxel_size));
}

constexpr const char* header =
    "pair,answer,kind,source_scene,target_scene,source_seed,target_seed,source_points,target_points,noise,"
    "station_distance,field_of_view_deg,overlap,rotation_error_deg,displacement_voxels,right,has_estimate,registered,"
    "confidence,quality,contact_share,mutual_matches,agreeing_matches,rival_odds,runner_up_share,free_directions,"
    "estimated_overlap,source_keypoints,target_keypoints,evidence_voxels,violation\n";

std::string row(std::uint64_t number, std::string_view answer, const Pair& pair, double overlap, const Result& result) {
  const Recipe& recipe = pair.recipe;
  const Evidence& e = result.evidence;
  const Error error = error_of(result, pair.truth, pair);
  return fmt::format("{},{},{},{},{},{},{},{},{},{:.3g},{:.3g},{:.0f},{:.3f},{:.3f},{:.2f},{:d},{:d},{:d},", number,
                     answer, to_string(recipe.kind), recipe.source_scene, recipe.target_scene, recipe.source_seed,
                     recipe.target_seed, pair.source.points.size(), pair.target.points.size(), recipe.noise,
                     recipe.station_distance, recipe.field_of_view_deg, overlap,
                     error.rotation_rad * 180.0 / std::numbers::pi, error.displacement, is_right(pair, result),
                     result.has_estimate, result.registered) +
         fmt::format("{:.6g},{:.4f},{:.4f},{},{},{:.4g},{:.3f},{},{:.3f},{},{},{:g},{:.4f}\n", result.confidence,
                     e.quality, e.contact_share, e.mutual_matches, e.agreeing_matches, e.rival_odds,
                     result.runner_up ? result.runner_up->share : 0.0, result.precision.free_directions.size(),
                     result.overlap(), result.source.keypoints, result.target.keypoints,
                     e.voxel_size / result.voxel_size, e.free_space.violation());
}

std::string rows_of(std::uint64_t number, std::uint64_t seed, bool viewpoints) {
  Pair pair = make_pair(number, seed);
  if (!viewpoints) pair.source.viewpoint = pair.target.viewpoint = std::nullopt;
  Options options;
  options.threads = 1;
  options.scale.voxel_size = choose_voxel_size(pair.source.points, pair.target.points, options.scale);
  const Features source = extract_features(pair.source, options);
  const Features target = extract_features(pair.target, options);
  const Result result = align(source, target, options);
  const double overlap = overlap_of(pair, result.voxel_size);
  std::string rows = row(number, "answer", pair, overlap, result);
  if (pair.recipe.kind != Kind::ambiguous && result.runner_up) {
    const Result second = align(source, target, result.runner_up->target_from_source, options);
    const bool says_the_same = error_of(second, result.target_from_source, pair).is_same_pose();
    if (!is_right(pair, second) && !says_the_same) rows += row(number, "runner_up", pair, overlap, second);
  }
  return rows;
}

std::vector<std::string> run(int first, int pairs, std::uint64_t seed, int jobs, bool viewpoints) {
  std::vector<std::string> rows(pairs);
  std::atomic<int> next = 0;
  const auto work = [&] {
    for (int i = next++; i < pairs; i = next++) {
      rows[i] = rows_of(first + i, seed, viewpoints);
      if ((i + 1) % 20 == 0) std::cerr << fmt::format("{} of {} pairs\n", i + 1, pairs);
    }
  };
  std::vector<std::jthread> workers;
  for (int i = 0; i < jobs; ++i) workers.emplace_back(work);
  workers.clear();  // joins
  return rows;
}

}  // namespace
}  // namespace igsp::calibration

int main(int argc, char** argv) {
  int first = 0, pairs = 800, jobs = 1;
  std::uint64_t seed = 1;
  bool viewpoints = false;
  std::string path;
  CLI::App app("Registers simulated pairs of known truth and writes what the verdict said of each");
  app.add_option("--first", first, "number of the first pair")->check(CLI::NonNegativeNumber);
  app.add_option("--pairs", pairs)->check(CLI::PositiveNumber);
  app.add_option("--seed", seed);
  app.add_option("--jobs", jobs)->check(CLI::PositiveNumber);
  app.add_flag("--viewpoints", viewpoints, "where the scanners stood is known");
  app.add_option("--out", path, "CSV file")->required();
  CLI11_PARSE(app, argc, argv);
  const std::vector<std::string> rows = igsp::calibration::run(first, pairs, seed, jobs, viewpoints);
  std::ofstream file(path);
  file << igsp::calibration::header;
  for (const std::string& row : rows) file << row;
  return file.flush() ? 0 : 1;
}
