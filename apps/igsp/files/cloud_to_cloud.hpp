#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "files/cloud_input.hpp"

namespace igsp::cli {

/// What every command asks for that makes one cloud out of another.
struct CloudToCloud {
  std::filesystem::path source, output;
  ReadOptions read;
  bool quiet = false;
};

/// Adds CLOUD, -o, --columns and --quiet, which fill `settings`; they live as long as the command.
void add_cloud_to_cloud_flags(CLI::App& command, CloudToCloud& settings, const std::string& written);

/// Throws InvalidArgument or FileError where the output is the input or cannot be made: before a long run, not after
/// it.
void check_cloud_to_cloud(const CloudToCloud& settings);

/// Warnings of `left_out_of`, on standard error, unless --quiet.
void print_left_out(const CloudToCloud& settings, const CloudInput& cloud);

/// To what coordinates must be exact: far below what the cloud resolves; 0 for one that has no extent. `sample` is of
/// its points.
double tolerance_of(PointView sample);

/// As many points as tell how fine a cloud resolves.
inline constexpr std::size_t sample_size = 200'000;

}  // namespace igsp::cli
