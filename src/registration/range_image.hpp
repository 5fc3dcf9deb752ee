#pragma once

#include <vector>

#include "igsp/point_cloud.hpp"
#include "spatial/point_grid.hpp"

namespace igsp {

/// What one scan saw from where its scanner stood: its points projected onto the sphere about the viewpoint at their
/// median range, with the range of each. There are no cells whose axes could matter: a direction is answered by the
/// points within a small aperture about it, a larger one where they lie on a single scan line. A viewpoint far away
/// makes the sphere a plane and the lines of sight parallel, without a case of its own.
class RangeImage {
 public:
  /// `points` (about `voxel_size` apart or less) and `viewpoint` in one frame, centred on the cloud.
  RangeImage(PointView points, const Eigen::Vector3d& viewpoint, double voxel_size);

  /// What the scanner says of the space at a point.
  enum class Sight {
    out_of_view,  ///< nothing was seen in this direction, or on one side of it only: the rim of what was seen
    possible,     ///< as far away as what was seen, or hidden behind it
    empty         ///< in front of everything that was seen about this direction
  };
  struct Look {
    Sight sight;
    double growth;  ///< of the aperture, which this took: 1, 2, 4 or 8
  };
  Look look_at(const Eigen::Vector3d& point) const;

 private:
  Points project(PointView points) const;
  Eigen::Vector3d on_sphere(const Eigen::Vector3d& ray, double range) const {
    return viewpoint_ + ray * (radius_ / range);
  }

  Eigen::Vector3d viewpoint_;
  double aperture_;   // on the sphere
  double tolerance_;  // along the line of sight
  double radius_;     // of the sphere
  PointGrid projected_;
  std::vector<double> ranges_;  // in the order of the grid
};

}  // namespace igsp
