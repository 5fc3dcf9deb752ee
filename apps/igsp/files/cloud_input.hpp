#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "igsp/io.hpp"
#include "igsp/progress.hpp"
#include "igsp/viewpoint.hpp"
#include "spatial/scale.hpp"

namespace igsp::cli {

/// One of several scans in a file.
struct FilePart {
  std::size_t total = 0;   ///< finite points of it in the file
  std::size_t points = 0;  ///< of them, or of their centroids, those in memory
  std::optional<Eigen::Vector3d> declared_viewpoint;
};

/// A cloud as it came from a file.
struct CloudInput {
  std::filesystem::path path;
  ReadOptions options;      ///< as it was read, and is read again
  std::string format;       ///< for people: "PLY, ascii"
  Points points;            ///< all of them, or a sample if the file holds more than were asked for
  std::size_t total = 0;    ///< finite points in the file
  std::size_t dropped = 0;  ///< points left out for a coordinate that is not finite
  std::size_t noise = 0;    ///< points of LAS and LAZ left out: classified as noise, or withheld
  Bounds bounds;            ///< of all points
  std::optional<Eigen::Vector3d> declared_viewpoint;  ///< what the file says
  double scale = 1.0;                                 ///< that `points` and the viewpoint are multiplied by
  std::vector<FilePart> parts;                        ///< of a file of several scans, in the order of the points
  ViewpointFinding viewpoint;                         ///< where the scanner stood; unknown until settle_viewpoint
  bool whole() const { return points.size() == total; }
  Scan scan() const;
};

/// Reads a cloud in one pass; of one of more than `max_points` a sample is kept that does not depend on their order, so
/// that memory stays bounded. `stage` is the name of the progress. Throws FileError (also for a cloud without any
/// extent).
CloudInput read_cloud(const std::filesystem::path& path, std::size_t max_points, std::string_view stage,
                      const ProgressCallback& progress, const ReadOptions& options = {});

/// Multiplies what is in memory; `bounds` and declared viewpoints stay those of the file.
void scale_cloud(CloudInput& cloud, double factor);

/// The same for any cloud, also an empty one or one without extent.
CloudInput sample_cloud(const std::filesystem::path& path, std::size_t max_points, std::string_view stage,
                        const ProgressCallback& progress, const ReadOptions& options = {});

/// Which points of the file are not in the cloud, a line for the user each; mostly none.
std::vector<std::string> left_out_of(const CloudInput& cloud);

/// Settles where the scanner stood, from the points in memory; a viewpoint that was asked for is one of the file's
/// frame.
void settle_viewpoint(CloudInput& cloud, const ViewpointRequest& request);

/// Voxel centroids of the whole file, in its frame, in place of the points in memory; of several scans, of each. Read
/// in chunks: memory grows with the voxels only.
void take_centroids(CloudInput& cloud, double voxel_size, std::string_view stage, const ProgressCallback& progress);

}  // namespace igsp::cli
