#include "files/cloud_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/report_progress.hpp"
#include "files/cloud_file.hpp"
#include "files/point_sample.hpp"
#include "igsp/errors.hpp"
#include "spatial/trimmed_cloud.hpp"
#include "spatial/voxel_grid.hpp"

namespace igsp::cli {
namespace {

constexpr double max_voxels_away = 1 << 18;

std::vector<FilePart> parts_of(const std::vector<ScanPart>& declared, const std::vector<std::size_t>& in_memory) {
  std::vector<FilePart> parts;
  for (std::size_t i = 0; i < declared.size(); ++i) {
    parts.push_back({declared[i].points, in_memory[i], declared[i].viewpoint});
  }
  return parts;
}

// What is in memory of each part has changed.
void set_part_sizes(CloudInput& cloud, const std::vector<std::size_t>& sizes) {
  for (std::size_t i = 0; i < cloud.parts.size(); ++i) cloud.parts[i].points = sizes[i];
  for (std::size_t i = 0; i < cloud.viewpoint.parts.size(); ++i) cloud.viewpoint.parts[i].points = sizes[i];
}

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
  PointSample kept(max_points, reader.declared_points());
  for (PointView chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
    for (const Eigen::Vector3d& point : chunk) {
      cloud.bounds.min = cloud.bounds.min.cwiseMin(point);
      cloud.bounds.max = cloud.bounds.max.cwiseMax(point);
    }
    kept.add(chunk, reader.part());
    cloud.total += chunk.size();
    report_progress(progress, stage, cloud.total + reader.dropped() + reader.noise(), reader.declared_points());
  }
  cloud.points = kept.take();
  cloud.parts = parts_of(reader.parts(), kept.part_sizes());
  cloud.dropped = reader.dropped();
  cloud.declared_viewpoint = reader.viewpoint();
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
  for (ScanPart& part : cloud.viewpoint.parts) {
    if (part.viewpoint) *part.viewpoint *= factor;
  }
}

Scan CloudInput::scan() const {
  Scan scan(points, viewpoint.viewpoint);
  scan.parts = viewpoint.parts;
  return scan;
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
  if (cloud.parts.empty()) {
    cloud.viewpoint = find_viewpoint(cloud.points, request, cloud.declared_viewpoint);
    return;
  }
  std::vector<ScanPart> declared;
  for (const FilePart& part : cloud.parts) declared.push_back({part.points, part.declared_viewpoint});
  cloud.viewpoint = find_viewpoints(cloud.points, request, declared);
}

void take_centroids(CloudInput& cloud, double voxel_size, std::string_view stage, const ProgressCallback& progress) {
  CloudFile reader(cloud.path, cloud.options);
  const TrimmedCloud kept(cloud.points, cloud.path.string());
  const Eigen::Vector3d origin = centre_of(kept.bounds());
  // Farther than a voxel filter can hold lie stray points alone: they stay as they are, so that `align` tells of them.
  const double reach = (kept.bounds().max - kept.bounds().min).maxCoeff() + max_voxels_away * voxel_size;
  struct Part {
    VoxelFilter filter;
    Points far = {};
  };
  std::vector<Part> parts(std::max<std::size_t>(1, cloud.parts.size()), {VoxelFilter(origin, voxel_size)});
  Points near;
  std::size_t read = 0;
  for (PointView chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
    report_progress(progress, stage, read, cloud.total);
    read += chunk.size();
    Part& part = parts.at(reader.part());
    near.clear();
    for (const Eigen::Vector3d& point : chunk) {
      ((point - origin).cwiseAbs().maxCoeff() < reach ? near : part.far).push_back(point);
    }
    part.filter.add(near);
  }
  cloud.points.clear();
  std::vector<std::size_t> sizes;
  for (const Part& part : parts) {
    const std::size_t before = cloud.points.size();
    for (const Eigen::Vector3d& centroid : part.filter.centroids()) cloud.points.push_back(centroid + origin);
    cloud.points.insert(cloud.points.end(), part.far.begin(), part.far.end());
    sizes.push_back(cloud.points.size() - before);
  }
  set_part_sizes(cloud, sizes);
}

}  // namespace igsp::cli
