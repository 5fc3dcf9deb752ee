#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files/csv.hpp"

namespace igsp::cli {

/// A line of results.csv: a case and a preset. Empty: does not apply or is not known.
struct BenchmarkRow {
  std::string name, group, preset;
  std::string scramble;  ///< the seed, or "none"
  std::string truth;     ///< "known", "none", "-"
  std::string verdict;   ///< "registered", "not_registered", empty after an error
  std::optional<bool> success;
  std::optional<double> confidence, e_r_deg, e_t, centroid_displacement, overlap;
  std::optional<double> precision, recall;  ///< of the correspondences, Eq. 14
  std::optional<double> iterations, source_keypoints, target_keypoints, voxel_size;
  std::string stage_seconds;  ///< "read=0.012;scale=0.003;..."
  std::optional<double> cpu_seconds, wall_seconds, peak_memory_bytes;
  std::string reason;  ///< the verdict's
  std::string error;   ///< why there is no answer

  bool registered() const { return verdict == "registered"; }
  bool false_accept() const { return registered() && success == false; }
  bool right_and_said() const { return registered() && success == true; }
};

std::string results_header();
std::string results_line(const BenchmarkRow& row);

/// All rows. Columns may stand in any order, unknown ones are skipped; name, preset, verdict and success must be there.
/// Throws FileError with line and column.
std::vector<BenchmarkRow> read_results(const std::filesystem::path& path, LastLine last_line = LastLine::any);

}  // namespace igsp::cli
