#include "benchmark_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <new>
#include <numbers>
#include <numeric>

#include "benchmark_judgement.hpp"
#include "cloud_input.hpp"
#include "igsp/align.hpp"
#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "interrupt.hpp"
#include "report.hpp"

namespace igsp::cli {
namespace {

// Wall and CPU seconds of the calling thread.
struct Seconds {
  double wall = 0.0, cpu = 0.0;

  static Seconds now() {
    timespec cpu{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &cpu);
    return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
            static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec)};
  }
};
Seconds operator-(const Seconds& a, const Seconds& b) {
  return {a.wall - b.wall, a.cpu - b.cpu};
}
Seconds operator+(const Seconds& a, const Seconds& b) {
  return {a.wall + b.wall, a.cpu + b.cpu};
}

// Relative to the first point: survey coordinates lose nothing.
Eigen::Vector3d centroid_of(PointView points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point - points.front();
  return points.front() + sum / static_cast<double>(points.size());
}

std::string stages_text(const Result& result, double read_seconds) {
  std::string text = fmt::format("read={:.6f}", read_seconds);
  for (const auto& [stage, seconds] : result.timings_s) text += fmt::format(";{}={:.6f}", stage, seconds);
  return text;
}

void fill(BenchmarkRow& row, const Result& result, const Judgement& judgement) {
  row.verdict = result.registered ? "registered" : "not_registered";
  row.reason = result.reason;
  row.success = judgement.success;
  row.confidence = result.confidence;
  if (judgement.error) {
    row.e_r_deg = judgement.error->rotation_rad * 180.0 / std::numbers::pi;
    row.e_t = judgement.error->translation;
    row.centroid_displacement = judgement.error->centroid_displacement;
  }
  if (result.has_estimate) row.overlap = result.overlap();
  row.iterations = result.iterations.size();
  row.source_keypoints = result.source.keypoints;
  row.target_keypoints = result.target.keypoints;
  row.voxel_size = result.voxel_size;
}

void run_case(const BenchmarkTask& task, BenchmarkRow& row) {
  const auto go_on = [](const Progress&) { return !interrupted(); };
  const std::size_t all_points = std::numeric_limits<std::size_t>::max();
  Options options = preset(task.preset);
  options.threads = 1;
  const Transformation truth =
      task.one.truth == Truth::known ? read_transformation(task.one.truth_file) : Transformation::Identity();

  const Seconds start = Seconds::now();
  CloudInput source = read_cloud(task.one.source, all_points, "read source", go_on);
  const CloudInput target = read_cloud(task.one.target, all_points, "read target", go_on);
  const Seconds read = Seconds::now() - start;

  const Eigen::Vector3d centroid = centroid_of(source.points);
  Transformation motion = Transformation::Identity();
  if (task.scramble_seed) {
    motion = scramble(*task.scramble_seed, task.one.name, centre_of(source.bounds), source.bounds.diagonal());
    for (Eigen::Vector3d& point : source.points) point = motion * point;
  }

  const Seconds before = Seconds::now();
  const Result result = align(source.points, target.points, options, go_on);
  const Seconds spent = read + (Seconds::now() - before);
  row.cpu_seconds = spent.cpu;
  row.wall_seconds = spent.wall;
  row.peak_memory_bytes = peak_memory_bytes();
  row.stage_seconds = stages_text(result, read.wall);
  fill(row, result, judge_case(task.one, truth, centroid, motion, result));
}

}  // namespace

std::string scramble_text(const std::optional<std::uint64_t>& seed) {
  return seed ? fmt::format("{}", *seed) : "none";
}

BenchmarkRow run_task(const BenchmarkTask& task) {
  BenchmarkRow row;
  row.name = task.one.name;
  row.group = task.one.group;
  row.preset = task.preset;
  row.scramble = scramble_text(task.scramble_seed);
  row.truth = to_string(task.one.truth);
  try {
    run_case(task, row);
  } catch (const Cancelled&) {
    throw;
  } catch (const std::bad_alloc&) {
    row.error = "not enough memory";
  } catch (const std::exception& error) {
    stop_if_interrupted();  // a read that was interrupted fails as a file does
    row.error = error.what();
  }
  return row;
}

void reset_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

}  // namespace igsp::cli
