#include "benchmark/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <new>
#include <numbers>

#include "benchmark/judgement.hpp"
#include "benchmark/pair.hpp"
#include "igsp/align.hpp"
#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "report/json.hpp"
#include "shell/interrupt.hpp"

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
  Options options = preset(task.preset);
  options.threads = 1;

  const Seconds start = Seconds::now();
  BenchmarkPair pair = read_pair(task.one);
  const Seconds read = Seconds::now() - start;
  if (task.scramble_seed) scramble_source(pair, task.one, *task.scramble_seed);

  const Seconds before = Seconds::now();
  const Result result = align(pair.source.scan(), pair.target.scan(), options, go_on);
  const Seconds spent = read + (Seconds::now() - before);
  row.cpu_seconds = spent.cpu;
  row.wall_seconds = spent.wall;
  row.peak_memory_bytes = peak_memory_bytes();
  row.stage_seconds = stages_text(result, read.wall);
  fill(row, result, judge_case(task.one, pair.truth, pair.source_centroid, pair.motion, result));
  if (task.one.truth != Truth::known) return;
  if (const auto quality = judge_matches(result, pair.target_from_scrambled())) {
    row.precision = quality->precision();
    row.recall = quality->recall();
  }
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
