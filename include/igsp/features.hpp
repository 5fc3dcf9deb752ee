#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "igsp/options.hpp"
#include "igsp/point_cloud.hpp"
#include "igsp/progress.hpp"

namespace igsp {

/// Binary Shape Context: 435 bits (147 occupancy, 3 planes x 48 depth, 3 planes x 48 density), padded to 448.
inline constexpr int bsc_bits = 435;
inline constexpr int bsc_words = 7;
using Descriptor = std::array<std::uint64_t, bsc_words>;

/// What one of several scans saw, where its viewpoint is known.
struct ScannedPart {
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();  ///< local
  Points fine_points;                                   ///< centroids of the finer voxels of its own points, local
};

/// What the method knows of one cloud. Coordinates are relative to `origin` (world = local + origin), so that clouds in
/// survey coordinates lose nothing.
struct Features {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> viewpoint;  ///< where the scanner stood, local; none: unknown, or several
  std::vector<ScannedPart> parts;            ///< of a cloud of several scans, those whose viewpoint is known
  double voxel_size = 0.0;
  Points points;                         ///< voxel centroids, local
  std::vector<float> curvature;          ///< per point: surface variation, [0, 1/3]
  Points normals;                        ///< per point: unit, sign arbitrary
  Points fine_points;                    ///< centroids of finer voxels, local: what fine registration works on
  std::vector<std::uint32_t> keypoints;  ///< indices into `points`, by curvature descending
  std::vector<Eigen::Matrix3d> frames;   ///< per keypoint: columns x, y, n of the local reference frame
  std::vector<Descriptor> descriptors;   ///< per keypoint, in its frame
  std::size_t cloud_points = 0;          ///< of the cloud as given
  StrayPoints stray;                     ///< of them, those that were left out
  /// The same at voxels of 2, 4 and 8 times the size, as far as there are enough of them: what a search begins with.
  std::vector<Features> coarser;
  std::vector<std::pair<std::string, double>> timings_s;  ///< per stage, wall seconds, in order
};

/// Everything that depends on one cloud alone. Uses options.scale.voxel_size, or the cloud's own scale when it is 0.
/// Throws InvalidArgument (empty cloud, non-finite point or viewpoint, wrong parts, option out of range), Cancelled.
Features extract_features(const Scan& cloud, const Options& options = {}, const ProgressCallback& progress = {});

}  // namespace igsp
