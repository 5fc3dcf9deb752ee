#pragma once

#include <span>
#include <vector>

#include "igsp/features.hpp"
#include "igsp/network.hpp"

namespace igsp::cli {

/// What the page draws of a scan, in the scan's own frame.
struct DrawnScan {
  Eigen::Vector3d station = Eigen::Vector3d::Zero();  ///< where the scanner stood, else the centre of the scan
  bool station_known = false;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of `points`
  std::vector<float> points;                         ///< x, y, z of some voxel centroids, relative to `origin`
  /// Of these points, see measure_drawn; infinite where no other scan is. Empty: not known.
  std::vector<float> distances;
};

/// `scans`: how many share the page.
DrawnScan drawn_scan(const Features& features, std::size_t scans);

/// How far a neighbour may be whose surface a drawn point is compared with [voxels].
inline constexpr double neighbour_reach = 3.0;

/// Fills in the distance of every drawn point, at the poses of the network, from the surface of the other scans of its
/// frame: along the normal of the nearest voxel of them all [units of the cloud]. One scan's features at a time are in
/// memory. Where one cannot be had again no distances are known. Throws Cancelled after an interrupt.
void measure_drawn(std::span<DrawnScan> drawn, const Network& network, const FeatureSource& features, int threads);

}  // namespace igsp::cli
