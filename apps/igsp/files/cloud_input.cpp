#include "files/cloud_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/cloud_file.hpp"
#include "files/point_sample.hpp"
#include "igsp/errors.hpp"
#include "spatial/trimmed_cloud.hpp"
#include "spatial/voxel_grid.hpp"

namespace igsp::cli {
namespace {

void report(const ProgressCallback& progress, std::string_view stage, std::size_t done, std::size_t all) {
  const double fraction = all > 0 ? std::min(1.0, static_cast<double>(done) / static_cast<double>(all)) : 0.0;
  if (progress && !progress({stage, fraction})) throw Cancelled();
}

constexpr double max_voxels_away = 1 << 18;

void check_extent(const CloudInput& cloud) {
  const auto fail = [&](const std::string& why) {
    const std::string dropped =
        cloud.dropped > 0 ? fmt::format(" ({} dropped for a coordinate that is not finite)", cloud.dropped) : "";
    throw FileError(fmt::format("{}: {}{}", cloud.path.string(), why, dropped));
  };
  if (cloud.total == 0) fail("holds no finite point");
  if (cloud.total == 1) fail("holds a single point");
  if (cloud.bounds.diagonal() == 0.0) fail(fmt::format("all {} points are equal", cloud.total));
}

}  // namespace

CloudInput sample_cloud(const std::filesystem::path& path, std::size_t max_points, std::string_view stage,
                        const ProgressCallback& progress, const ReadOptions& options) {
  CloudFile reader(path, options);
  CloudInput cloud;
  cloud.path = path;
  cloud.options = options;
  cloud.format = reader.format();
  cloud.bounds = {Eigen::Vector3d::Constant(HUGE_VAL), Eigen::Vector3d::Constant(-HUGE_VAL)};
  PointSample kept(max_points);
  for (PointView chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
    for (const Eigen::Vector3d& point : chunk) {
      cloud.bounds.min = cloud.bounds.min.cwiseMin(point);
      cloud.bounds.max = cloud.bounds.max.cwiseMax(point);
    }
    kept.add(chunk);
    cloud.total += chunk.size();
    report(progress, stage, cloud.total + reader.dropped() + reader.noise(), reader.declared_points());
  }
  cloud.points = kept.take();
  cloud.dropped = reader.dropped();
  cloud.declared_viewpoint = reader.viewpoint();
  cloud.scans = reader.scans();
  cloud.noise = reader.noise();
  return cloud;
}

CloudInput read_cloud(const std::filesystem::path& path, std::size_t max_points, std::string_view stage,
                      const ProgressCallback& progress, const ReadOptions& options) {
  CloudInput cloud = sample_cloud(path, max_points, stage, progress, options);
  check_extent(cloud);
  return cloud;
}

void scale_cloud(CloudInput& cloud, double factor) {
  cloud.scale *= factor;
  for (Eigen::Vector3d& point : cloud.points) point *= factor;
  if (cloud.viewpoint.viewpoint) *cloud.viewpoint.viewpoint *= factor;
}

std::vector<std::string> left_out_of(const CloudInput& cloud) {
  std::vector<std::string> lines;
  if (cloud.noise > 0) {
    lines.push_back(
        fmt::format("{}: left out {} points that are classified as noise (7, 18) or withheld; --keep-noise "
                    "keeps them",
                    cloud.path.string(), cloud.noise));
  }
  if (cloud.dropped > 0) {
    lines.push_back(fmt::format("{}: dropped {} of {} points with a coordinate that is not finite", cloud.path.string(),
                                cloud.dropped, cloud.dropped + cloud.total));
  }
  return lines;
}

void settle_viewpoint(CloudInput& cloud, const ViewpointRequest& request) {
  if (request.kind == ViewpointRequest::Kind::automatic && cloud.scans > 1) {
    cloud.viewpoint = {
        {}, fmt::format("unknown: {} scans in one file, each with a viewpoint of its own", cloud.scans), ""};
    return;
  }
  cloud.viewpoint = find_viewpoint(cloud.points, request, cloud.declared_viewpoint);
}

Points read_centroids(const CloudInput& cloud, double voxel_size, std::string_view stage,
                      const ProgressCallback& progress) {
  CloudFile reader(cloud.path, cloud.options);
  const TrimmedCloud kept(cloud.points, cloud.path.string());
  const Eigen::Vector3d origin = centre_of(kept.bounds());
  // Farther than a voxel filter can hold lie stray points alone: they stay as they are, so that `align` tells of them.
  const double reach = (kept.bounds().max - kept.bounds().min).maxCoeff() + max_voxels_away * voxel_size;
  Points near, far;
  std::size_t read = 0;
  Points centroids = voxel_centroids(
      [&] {
        report(progress, stage, read, cloud.total);
        near.clear();
        for (PointView chunk = reader.next_chunk(); near.empty() && !chunk.empty();) {
          read += chunk.size();
          for (const Eigen::Vector3d& point : chunk) {
            ((point - origin).cwiseAbs().maxCoeff() < reach ? near : far).push_back(point);
          }
          if (near.empty()) chunk = reader.next_chunk();
        }
        return PointView(near);
      },
      origin, voxel_size);
  for (Eigen::Vector3d& centroid : centroids) centroid += origin;
  centroids.insert(centroids.end(), far.begin(), far.end());
  return centroids;
}

}  // namespace igsp::cli
