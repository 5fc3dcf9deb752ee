#pragma once

#include "registration/point_to_plane.hpp"
#include "registration/prepared_cloud.hpp"

namespace igsp {

/// How the surface of `moved` lies on the surface of `fixed`.
struct SurfaceContact {
  double share = 0.5;  ///< of the places where the two meet, the share where they touch, weighted by curvature; (0, 1)
  double overlap = 0;  ///< share of all voxels of `moved` that lie on `fixed`, [0, 1]
};

/// Of the voxels of one cloud that were looked at, those beside the surface of the other and of them those on it.
struct SurfaceOverlap {
  std::size_t places = 0, met = 0, covered = 0;
  double share() const;  ///< of all places, those on the surface, [0, 1]
};

/// The overlap alone, which asks for no normals but those of the places that are met.
SurfaceOverlap overlap_of(PointView moved, const Surface& fixed, double voxel_size,
                          const Transformation& fixed_from_moved);

/// Places beyond the rim of `fixed` do not count, so the overlap does not matter for `share`; surfaces that merely
/// cross give about 1/4. Weights by surface variation, since flat ground touches under any pose that keeps it level.
SurfaceContact surface_contact(const PreparedCloud& moved, const PreparedCloud& fixed,
                               const Transformation& fixed_from_moved);

}  // namespace igsp
