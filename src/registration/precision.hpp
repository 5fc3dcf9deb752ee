#pragma once

#include "igsp/result.hpp"
#include "registration/point_to_plane.hpp"
#include "registration/prepared_cloud.hpp"

namespace igsp {

/// Root mean square distance of the points from their centroid: the length that makes a rotation of one radian
/// comparable with a translation.
double size_of(PointView points);

/// Both clouds as fine registration sees them: voxels of v/2.
struct FineSurfaces {
  FineSurfaces(const Features& source_features, const Features& target_features, int threads);
  Surface source;
  Surface target;
  double voxel_size;  ///< v
  int threads;        ///< for what is done with them
};

/// Inlier RMSE, information, covariance and scale at a pose; free directions are left empty.
Precision precision_at(const FineSurfaces& surfaces, const Transformation& target_from_source, int degrees_of_freedom);

/// Whether the surfaces at the pose say that the source is several percent too large or too small: no rigid motion puts
/// such a cloud where it belongs.
bool is_of_another_scale(const Precision& precision);

/// Such as "translation along (1.00, 0.00, 0.00)"; rotations scaled by the size of the scene.
std::string describe_motion(const Eigen::Matrix<double, 6, 1>& motion);

/// Motions of 8 voxels after which the surfaces touch as much as before: what the surfaces do not fix. Candidates are
/// the weakest eigenvectors of the normal equations at the pose. Called with one cloud twice and the identity, these
/// are the motions that slide it along itself. In the coordinates of `fixed`.
std::vector<FreeDirection> free_directions(const PreparedCloud& moved, const PreparedCloud& fixed,
                                           const Transformation& fixed_from_moved, int threads = 1);

}  // namespace igsp
