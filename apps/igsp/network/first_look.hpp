#pragma once

#include <string>
#include <vector>

#include "network/engine.hpp"

namespace igsp::cli {

/// What a first look at all scans says.
struct FirstLook {
  double voxel_size = 0;              ///< for all; 0 if none can be read
  std::vector<std::string> warnings;  ///< scans in another unit of length than the others
};
FirstLook look_at_scans(Engine& engine, const ScanReading& reading, const Options& options,
                        const ProgressCallback& progress);

}  // namespace igsp::cli
