#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "igsp/network.hpp"
#include "network/inputs.hpp"

namespace igsp::cli {

/// Throws InvalidArgument where two files would be written under one name in `folder`, or one over itself.
void check_moved_scans(const std::filesystem::path& folder, const ScanReading& reading);

/// Writes every scan that lies with others moved into its component's world, in its own format with all that belongs to
/// its points: under its file's name in `folder` if it is of the largest component, else in folder/component_1, ...
/// Scans of one file share a file, in the folder of the first of them that lies with others. Returns lines on what
/// could not be kept. Throws FileError, InvalidArgument, Cancelled.
std::vector<std::string> write_moved_scans(const std::filesystem::path& folder, const Network& network,
                                           const ScanReading& reading, const ProgressCallback& progress);

/// Throws FileError unless a merged cloud can be written there: asked before a long run, not after it.
void check_merged(const std::filesystem::path& path);

/// Writes the scans of the largest component as one cloud: a point per half voxel of the network, read in chunks, so
/// that memory grows with these alone. Returns their number. Throws as write_moved_scans.
std::size_t write_merged(const std::filesystem::path& path, const Network& network, const ScanReading& reading,
                         const ProgressCallback& progress);

}  // namespace igsp::cli
