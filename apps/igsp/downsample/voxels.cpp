#include "downsample/voxels.hpp"

#include <cmath>
#include <optional>

#include "core/report_progress.hpp"
#include "files/cloud_file.hpp"
#include "spatial/voxel_grid.hpp"

namespace igsp::cli {
namespace {

// What one pass over the file found; no filter where a point lay beyond its reach.
struct Pass {
  CloudInput cloud;
  std::optional<VoxelFilter> filter;
};

Pass pass_over(CloudInput cloud, const Eigen::Vector3d& origin, double voxel_size, bool near_only,
               std::string_view stage, const ProgressCallback& progress) {
  CloudFile reader(cloud.path, cloud.options);
  Pass pass{std::move(cloud), VoxelFilter(origin, voxel_size)};
  pass.cloud.format = reader.format();
  pass.cloud.total = 0;
  Bounds& bounds = pass.cloud.bounds;
  bounds = {Eigen::Vector3d::Constant(HUGE_VAL), Eigen::Vector3d::Constant(-HUGE_VAL)};
  for (PointView chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
    for (const Eigen::Vector3d& point : chunk) {
      bounds.min = bounds.min.cwiseMin(point);
      bounds.max = bounds.max.cwiseMax(point);
    }
    const double reach = 0.99 * VoxelFilter::reach * voxel_size;  // rounding must not decide
    const bool far = near_only && bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).maxCoeff() > reach;
    if (far) pass.filter.reset();
    if (pass.filter) pass.filter->add(chunk);
    pass.cloud.total += chunk.size();
    report_progress(progress, stage, pass.cloud.total + reader.dropped(), reader.declared_points());
  }
  pass.cloud.dropped = reader.dropped();
  pass.cloud.declared_viewpoint = reader.viewpoint();
  pass.cloud.noise = reader.noise();
  return pass;
}

}  // namespace

CloudInput voxels_of(const std::filesystem::path& path, double voxel_size, const ProgressCallback& progress,
                     const ReadOptions& options) {
  CloudInput cloud;
  cloud.path = path;
  cloud.options = options;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Pass pass = pass_over(std::move(cloud), origin, voxel_size, true, "filter", progress);
  if (!pass.filter) {
    origin = (centre_of(pass.cloud.bounds) / voxel_size).array().round() * voxel_size;
    pass = pass_over(std::move(pass.cloud), origin, voxel_size, false, "filter again", progress);
  }
  pass.cloud.points = pass.filter->centroids();
  for (Eigen::Vector3d& centroid : pass.cloud.points) centroid += origin;
  return std::move(pass.cloud);
}

}  // namespace igsp::cli
