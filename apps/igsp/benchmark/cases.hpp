#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "igsp/viewpoint.hpp"

namespace igsp::cli {

enum class Truth {
  known,    ///< a 4x4 file
  none,     ///< `none`: the pair does not overlap, the only right answer is "not registered"
  unknown,  ///< `-`: nobody knows, the answer is not judged
};
std::string_view to_string(Truth truth);

/// A pair of clouds and what counts as success.
struct BenchmarkCase {
  std::string name;
  std::string group;
  std::filesystem::path source, target;
  Truth truth = Truth::unknown;
  std::filesystem::path truth_file;  ///< target_from_source; empty unless the truth is known
  double max_rotation_error_deg = 0.0;
  ViewpointRequest source_viewpoint{.kind = ViewpointRequest::Kind::none};  ///< in the files' frames
  ViewpointRequest target_viewpoint{.kind = ViewpointRequest::Kind::none};
  double max_displacement = 0.0;  ///< of the source's centroid [units of the cloud]
};

/// Reads the list of cases; its paths are relative to the file. Throws FileError with line and column.
std::vector<BenchmarkCase> read_cases(const std::filesystem::path& path);

/// Those of the named groups and those whose name matches a pattern with * and ?, in order; all if nothing is asked
/// for. Throws InvalidArgument for a group or pattern that selects nothing.
std::vector<BenchmarkCase> select_cases(const std::vector<BenchmarkCase>& cases, const std::vector<std::string>& only);

}  // namespace igsp::cli
