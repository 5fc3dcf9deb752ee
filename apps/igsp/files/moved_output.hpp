#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "files/cloud_input.hpp"

namespace igsp::cli {

/// Throws InvalidArgument or FileError unless `source` can be written moved as `output`, a name of a format.
void check_moved_output(const std::filesystem::path& source, const std::filesystem::path& output);

/// Writes all points of `source`, moved: with all that belongs to them where the format of `output` is that of the
/// source, else x, y and z. Coordinates are floats only where these are exact to `tolerance`. Read again from its file
/// in chunks. Returns lines for the user on what became of the rest. Throws FileError, Cancelled.
std::vector<std::string> write_moved_output(const CloudInput& source, const std::filesystem::path& output,
                                            const Transformation& target_from_source, double tolerance,
                                            const ProgressCallback& progress);

}  // namespace igsp::cli
