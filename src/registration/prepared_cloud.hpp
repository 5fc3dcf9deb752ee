#pragma once

#include "igsp/features.hpp"
#include "registration/point_to_plane.hpp"
#include "spatial/point_grid.hpp"

namespace igsp {

/// A cloud's features with the search structure and the arrays that the registration stages share. Refers to
/// `features`.
struct PreparedCloud {
  explicit PreparedCloud(const Features& cloud_features)
      : features(cloud_features),
        grid(cloud_features.points, 3.0 * cloud_features.voxel_size),
        viewpoints(cloud_features, cloud_features.points) {
    keypoints.reserve(features.keypoints.size());
    for (const std::uint32_t i : features.keypoints) keypoints.push_back(features.points[i]);
  }

  const Features& features;
  PointGrid grid;         ///< of the voxel centroids
  Viewpoints viewpoints;  ///< of the same
  Points keypoints;       ///< positions
};

/// Its voxels, with the normals of its features.
inline Surface surface_of(const PreparedCloud& cloud) {
  return Surface(cloud.features.points, cloud.grid, cloud.features.normals, cloud.viewpoints);
}

}  // namespace igsp
