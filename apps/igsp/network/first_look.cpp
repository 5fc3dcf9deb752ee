#include "network/first_look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "igsp/errors.hpp"
#include "network/common_scale.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

constexpr double suspicious_ratio = 100;  // of extents: millimetres among metres are 1000

std::vector<std::string> warnings_about(const std::vector<std::pair<double, fs::path>>& extents) {
  std::vector<std::string> warnings;
  if (extents.empty()) return warnings;
  std::vector<std::pair<double, fs::path>> sorted = extents;
  std::ranges::nth_element(sorted, sorted.begin() + sorted.size() / 2);
  const double median = sorted[sorted.size() / 2].first;
  for (const auto& [extent, file] : extents) {
    if (extent < suspicious_ratio * median && median < suspicious_ratio * extent) continue;
    warnings.push_back(fmt::format("{}: in another unit than the others? Its extent is {:.4g}, their median {:.4g}",
                                   file.string(), extent, median));
  }
  return warnings;
}

}  // namespace

FirstLook look_at_scans(Engine& engine, const ScanReading& reading, const Options& options,
                        const ProgressCallback& progress) {
  std::vector<double> own;
  std::vector<std::pair<double, fs::path>> extents;
  for (std::size_t i = 0; i < reading.files.size(); ++i) {
    try {
      const ScanLook look = engine.look(i, options, progress);
      extents.emplace_back(look.extent, reading.files[i]);
      own.push_back(look.voxel_size);
    } catch (const FileError&) {
      // Said where the scan's features are read.
    } catch (const InvalidArgument&) {
    }
  }
  return {common_voxel_size(std::move(own)), warnings_about(extents)};
}

}  // namespace igsp::cli
