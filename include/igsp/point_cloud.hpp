#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace igsp {

/// Points in contiguous storage, metres (any unit of length works: nothing inside has a unit of its own).
using Points = std::vector<Eigen::Vector3d>;

/// A view of such points; a C-contiguous (N, 3) float64 array can be viewed without a copy.
using PointView = std::span<const Eigen::Vector3d>;

/// One of several scans in a cloud, whose points lie one after the other.
struct ScanPart {
  std::size_t points = 0;
  std::optional<Eigen::Vector3d> viewpoint;  ///< where its scanner stood, in the frame of the cloud; none: unknown
};

/// A cloud and, where it is known, where its scanner stood, in the frame of the points. A viewpoint many extents away
/// stands for a scanner that looked along one direction. None: unknown, or fused from scans of several places.
struct Scan {
  Scan(PointView scan_points, const std::optional<Eigen::Vector3d>& scan_viewpoint = {})
      : points(scan_points), viewpoint(scan_viewpoint) {}
  Scan(const Points& scan_points, const std::optional<Eigen::Vector3d>& scan_viewpoint = {})
      : points(scan_points), viewpoint(scan_viewpoint) {}

  PointView points;
  std::optional<Eigen::Vector3d> viewpoint;
  /// Of a cloud fused from several scans, if their points are not mixed: all of them, in the order of the points. Each
  /// has its own viewpoint then, and the cloud has none.
  std::vector<ScanPart> parts = {};
};

/// Few points far from all others: a row of zeros in survey coordinates, a -9999 for "nothing measured", a bird. One of
/// them would set the extent, and with it scale, centre and levers, so they are left out: at most 2 % of the points,
/// beyond a gap of at least half the extent that the others have along an axis.
struct StrayPoints {
  std::size_t count = 0;
  double extents_away = 0;  ///< the farthest one's distance to the box of the others, in diagonals of that box
};

/// Hands out a cloud in pieces: every call returns the next chunk, an empty one at the end. A chunk is valid until the
/// next call. Lets the voxel filter run over clouds that do not fit in memory.
using ChunkSource = std::function<PointView()>;

/// A rigid transformation. Named after its direction: p_target = target_from_source * p_source.
using Transformation = Eigen::Isometry3d;

}  // namespace igsp
