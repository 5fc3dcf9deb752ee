#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "igsp/features.hpp"
#include "igsp/io.hpp"
#include "igsp/network.hpp"
#include "igsp/progress.hpp"

namespace igsp::cli {

/// Files as given; a folder stands for the point clouds in it, in the order of their names, a file of several scans for
/// these (see scans_in). Throws FileError for a folder without any, InvalidArgument for a file given twice.
std::vector<std::filesystem::path> scan_files(const std::vector<std::filesystem::path>& given);

/// scan,x,y,z: where scanners stood, each in its own scan's frame. A scan is named as on the command line, by its file
/// name or by that without the extension. Throws FileError (also for a scan that is none of `files`).
std::map<std::filesystem::path, Eigen::Vector3d> read_viewpoints(const std::filesystem::path& path,
                                                                 const std::vector<std::filesystem::path>& files);

/// source,target: pairs of scans by their names, as above; either first. Throws as read_viewpoints.
std::vector<ScanPair> read_pairs(const std::filesystem::path& path, const std::vector<std::filesystem::path>& files);

/// The scan of that name, as above. Throws InvalidArgument that names `option`.
std::size_t scan_named(const std::string& name, const std::vector<std::filesystem::path>& files,
                       std::string_view option);

/// scan,x,y,z,sigma and, where the rotation is known, qw,qx,qy,qz,sigma_deg. Throws as read_viewpoints.
std::vector<ControlPose> read_control(const std::filesystem::path& path,
                                      const std::vector<std::filesystem::path>& files);

/// How the scans of a network are read.
struct ScanReading {
  std::vector<std::filesystem::path> files;
  std::map<std::filesystem::path, Eigen::Vector3d> viewpoints;
  ReadOptions read;
  std::size_t max_points = 20'000'000;
};

/// What a first look at a scan says [units of the cloud].
struct ScanLook {
  double voxel_size = 0;  ///< that it would have alone
  double extent = 0;
};

/// Throws FileError, InvalidArgument.
ScanLook look_at_scan(const ScanReading& reading, std::size_t scan, const ScaleOptions& scale,
                      const ProgressCallback& progress);

/// Throws FileError, InvalidArgument.
Features read_features(const ScanReading& reading, std::size_t scan, const Options& options,
                       const ProgressCallback& progress);

}  // namespace igsp::cli
