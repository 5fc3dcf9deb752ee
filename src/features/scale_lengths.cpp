#include "features/scale_lengths.hpp"

namespace igsp {

void scale_lengths(Features& features, double factor) {
  // All fields by name: one that is added to the struct does not build until someone has asked whether it is a length.
  auto& [origin, viewpoint, parts, voxel_size, points, curvature, normals, fine_points, keypoints, frames, descriptors,
         cloud_points, stray, coarser, timings_s] = features;
  origin *= factor;
  if (viewpoint) *viewpoint *= factor;
  for (ScannedPart& part : parts) {
    part.viewpoint *= factor;
    for (Eigen::Vector3d& point : part.fine_points) point *= factor;
  }
  voxel_size *= factor;
  for (Eigen::Vector3d& point : points) point *= factor;
  for (Eigen::Vector3d& point : fine_points) point *= factor;
  for (Features& scale : coarser) scale_lengths(scale, factor);
}

}  // namespace igsp
