#include "align/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

namespace igsp::cli {
namespace {

std::string iteration_table(const Result& result) {
  std::string text = fmt::format("\n{:>3} {:>6} {:>6} {:>8} {:>9} {:>8} {:>13} {:>11} {:>11} {:>8}\n", "k", "w_fd",
                                 "w_ed", "T_cd", "edges", "matches", "energy", "step [deg]", "step", "seconds");
  for (const IterationRecord& record : result.iterations) {
    text +=
        fmt::format("{:>3} {:>6.3f} {:>6.3f} {:>8.2f} {:>9} {:>8} {:>13.1f} {:>11.4g} {:>11.4g} {:>8.4f}\n", record.k,
                    record.w_fd, record.w_ed, record.t_cd, record.candidate_edges, record.matches, record.energy,
                    record.rotation_step_rad * 180.0 / std::numbers::pi, record.translation_step, record.seconds);
  }
  return text;
}

std::string timing_table(const Result& result) {
  std::string text = "\n";
  for (const auto& [stage, seconds] : result.timings_s) text += fmt::format("{:<24} {:8.4f} s\n", stage, seconds);
  return text;
}

std::string scanner_text(const CloudSummary& cloud) {
  if (!cloud.part_viewpoints.empty()) return fmt::format("scanner at {} places", cloud.part_viewpoints.size());
  if (!cloud.viewpoint) return "scanner unknown";
  return fmt::format("scanner at {:.6g}", fmt::join(cloud.viewpoint->begin(), cloud.viewpoint->end(), ", "));
}

std::string cloud_line(std::string_view name, const CloudSummary& cloud) {
  std::string text = fmt::format("{:<11} {} points, {} voxels, {} keypoints, {}\n", name, cloud.points, cloud.voxels,
                                 cloud.keypoints, scanner_text(cloud));
  if (cloud.stray.count > 0) text += fmt::format("{:<11} {}\n", "", stray_text(cloud));
  return text;
}

std::string scale_line(const Result& result, double scale) {
  const double sigma = scale * result.precision.scale_sigma;
  const std::string spread = sigma > 0 ? fmt::format(" +- {:.2g}", sigma) : "";
  return fmt::format("scale       {:.8g}{}: the source is multiplied by it, the matrix contains it\n", scale, spread);
}

}  // namespace

std::string matrix_text(const Transformation& transformation) {
  std::array<std::string, 4> lines;
  for (int column = 0; column < 4; ++column) {
    std::array<std::string, 4> numbers;
    std::size_t width = 0;
    for (int row = 0; row < 4; ++row) {
      numbers[row] = fmt::format("{}", transformation.matrix()(row, column));
      width = std::max(width, numbers[row].size());
    }
    for (int row = 0; row < 4; ++row) lines[row] += fmt::format("  {:>{}}", numbers[row], width);
  }
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

Transformation with_scale(Transformation target_from_source, double scale) {
  if (scale != 1) target_from_source.linear() *= scale;
  return target_from_source;
}

std::string stray_text(const CloudSummary& cloud) {
  const bool one = cloud.stray.count == 1;
  return fmt::format("{} of {} points {} {:.1f} extents away and {} left out", cloud.stray.count, cloud.points,
                     one ? "lies" : "lie up to", cloud.stray.extents_away, one ? "was" : "were");
}

std::string answer_text(const Result& result, double scale, const std::vector<Diagnosis>& diagnosis,
                        bool voxel_size_given, double seconds) {
  std::string text = fmt::format("{}: {}\n", result.registered ? "registered" : "not registered", result.reason);
  for (const Diagnosis& cause : diagnosis) text += fmt::format("diagnosis: {}\n", cause.description);
  if (result.has_estimate) {
    text += result.registered ? "target_from_source\n" : "best estimate of target_from_source, not to be relied on\n";
    text += matrix_text(with_scale(result.target_from_source, scale));
    if (scale != 1) text += scale_line(result, scale);
    text += fmt::format("confidence  {:.3f}\n", result.confidence);
    text += fmt::format("overlap     {:.3f} (source {:.3f}, target {:.3f})\n", result.overlap(), result.overlap_source,
                        result.overlap_target);
    text += fmt::format("RMSE        {:.4g}\n", result.rmse);
  }
  text += fmt::format("voxel size  {:.6g} ({})\n", result.voxel_size,
                      voxel_size_given ? "given" : "chosen from both clouds");
  text += cloud_line("source", result.source) + cloud_line("target", result.target);
  text += fmt::format("iterations  {} ({})\n", result.iterations.size(), to_string(result.termination));
  return text + fmt::format("time        {:.2f} s\n", seconds);
}

std::string details_text(const Result& result) {
  return iteration_table(result) + timing_table(result);
}

}  // namespace igsp::cli
