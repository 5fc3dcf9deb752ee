#include "igsp/features.hpp"

#include <fmt/format.h>

#include "core/parallel.hpp"
#include "core/stage_clock.hpp"
#include "features/bsc.hpp"
#include "features/extraction.hpp"
#include "features/keypoints.hpp"
#include "features/reference_frame.hpp"
#include "features/scale_lengths.hpp"
#include "igsp/errors.hpp"
#include "spatial/scale.hpp"
#include "spatial/scatter_filter.hpp"
#include "spatial/unit_of_length.hpp"
#include "spatial/voxel_grid.hpp"

namespace igsp {
namespace {

constexpr double fine_voxels = 0.5;  // voxels: finer ones brought no accuracy on scans whose truth is known

// The grid decides in which order a support is summed.
PointGrid support_grid(const Features& features, const Options& options) {
  return PointGrid(features.points, 0.5 * options.keypoints.pca_radius * features.voxel_size);
}

// Frames and descriptors of the keypoints.
void describe_keypoints(const PointGrid& grid, const Options& options, StageClock& clock, Features& features) {
  clock.start("descriptors");
  const double radius = options.descriptor.radius * features.voxel_size;
  features.frames.resize(features.keypoints.size());
  features.descriptors.resize(features.keypoints.size());
  const auto describe = [&](std::size_t begin, std::size_t end) {
    Support support;
    for (std::size_t i = begin; i < end; ++i) {
      gather_support(grid, features.points[features.keypoints[i]], radius, support);
      features.frames[i] = options.degrees_of_freedom == 4 ? levelled_reference_frame(support, radius)
                                                           : reference_frame(support, radius);
      features.descriptors[i] = binary_shape_context(support, features.frames[i], radius);
    }
  };
  parallel_slices(features.keypoints.size(), options.threads, 32, 256, describe,
                  [&](double share) { clock.report(share); });
}

// Normals and keypoints of the voxels.
void find_keypoints(const PointGrid& grid, const Options& options, StageClock& clock, Features& features) {
  clock.start("keypoints");
  const double pca_radius = options.keypoints.pca_radius * features.voxel_size;
  const LocalPca pca = local_pca(grid, pca_radius, options.threads, [&](double share) { clock.report(share); });
  features.curvature = pca.curvature;
  features.normals.resize(features.points.size());
  for (std::size_t i = 0; i < features.points.size(); ++i) features.normals[i] = pca.normals[i].cast<double>();
  features.keypoints = detect_keypoints(features.points, grid, pca, features.voxel_size, options.keypoints);
}

// Voxel boundaries start at the corner, which moves exactly with the cloud.
Points local_centroids(PointView cloud, const Bounds& bounds, double voxel_size) {
  Points centroids = voxel_centroids(cloud, bounds.min, voxel_size);
  const Eigen::Vector3d to_centre = 0.5 * (bounds.max - bounds.min);
  for (Eigen::Vector3d& point : centroids) point -= to_centre;
  return centroids;
}

// Where the scanners stood. Of several scans each saw its own points alone, so that voxels must not mix them.
void take_viewpoints(const TrimmedScan& scan, const ScatterFilter& filter, Features& features) {
  if (scan.parts.size() == 1) {
    features.viewpoint = *scan.parts.front().viewpoint - features.origin;
    return;
  }
  std::size_t begin = 0;
  for (const ScanPart& part : scan.parts) {
    const PointView points = scan.cloud.points().subspan(begin, part.points);
    begin += part.points;
    if (!part.viewpoint) continue;
    const Points kept = without_scatter(points, filter);
    features.parts.push_back({*part.viewpoint - features.origin,
                              local_centroids(kept, scan.cloud.bounds(), fine_voxels * features.voxel_size)});
  }
}

void add_coarser(const Options& options, StageClock& clock, Features& features) {
  clock.start("coarser scale");
  const ProgressCallback keep_asking = [&](const Progress&) {
    // Throws where the caller wants to stop.
    clock.report((static_cast<double>(features.coarser.size()) + 0.5) / (most_scales - 1));
    return true;
  };
  for (const Features* below = &features;
       features.coarser.size() + 1 < most_scales && below->points.size() >= enough_voxels_for_coarser;
       below = &features.coarser.back()) {
    Features coarser = coarser_voxels(*below);
    StageClock own(keep_asking);
    complete(options, own, coarser);
    features.coarser.push_back(std::move(coarser));
  }
}

// Where single precision is at home, and back.
Features extract_in_unit(double unit, const TrimmedScan& scan, Options options, const ProgressCallback& progress,
                         Described described) {
  options.scale.voxel_size /= unit;
  Features features = extract_features(scan.in_unit(unit), options, progress, described);
  scale_lengths(features, unit);
  return features;
}

}  // namespace

Features extract_features(const Scan& scan, const Options& options, const ProgressCallback& progress) {
  validate(options);
  return extract_features(TrimmedScan(scan, "cloud"), options, progress, Described::at_all_scales);
}

Features extract_features(const TrimmedScan& scan, const Options& options, const ProgressCallback& progress,
                          Described described) {
  const TrimmedCloud& trimmed = scan.cloud;
  const Bounds& bounds = trimmed.bounds();
  if (const double unit = unit_of_length(bounds, bounds, options.scale.voxel_size); unit != 1) {
    return extract_in_unit(unit, scan, options, progress, described);
  }
  PointView cloud = trimmed.points();
  StageClock clock(progress);
  Features features;
  features.cloud_points = cloud.size() + trimmed.stray().count;
  features.stray = trimmed.stray();
  clock.start("voxel grid");
  features.voxel_size = choose_voxel_size(trimmed, trimmed, options.scale);
  features.origin = centre_of(bounds);
  const ScatterFilter filter(cloud, bounds, scattered_noise(cloud, bounds), scatter_cell * features.voxel_size);
  const Points kept = filter.keeps_all() ? Points() : without_scatter(cloud, filter);
  if (!filter.keeps_all()) cloud = kept;
  features.points = local_centroids(cloud, bounds, features.voxel_size);
  features.fine_points = local_centroids(cloud, bounds, fine_voxels * features.voxel_size);
  take_viewpoints(scan, filter, features);

  if (described != Described::as_voxels) complete(options, clock, features);
  if (described == Described::at_all_scales) add_coarser(options, clock, features);
  clock.finish();
  features.timings_s = clock.timings();
  return features;
}

void complete(const Options& options, StageClock& clock, Features& features) {
  if (features.normals.size() == features.points.size()) return;
  const PointGrid grid = support_grid(features, options);
  find_keypoints(grid, options, clock, features);
  describe_keypoints(grid, options, clock, features);
}

Features mirrored_features(const Features& features, const Options& options) {
  const Eigen::Vector3d reflection(-1, 1, 1);
  Features image = features;
  image.coarser.clear();
  for (Points* points : {&image.points, &image.normals, &image.fine_points}) {
    for (Eigen::Vector3d& point : *points) point = point.cwiseProduct(reflection);
  }
  image.origin = image.origin.cwiseProduct(reflection);
  if (image.viewpoint) *image.viewpoint = image.viewpoint->cwiseProduct(reflection);
  for (ScannedPart& part : image.parts) {
    part.viewpoint = part.viewpoint.cwiseProduct(reflection);
    for (Eigen::Vector3d& point : part.fine_points) point = point.cwiseProduct(reflection);
  }
  const ProgressCallback silent;
  StageClock clock(silent);
  describe_keypoints(support_grid(image, options), options, clock, image);
  return image;
}

Features coarser_voxels(const Features& finer) {
  Features features;
  features.origin = finer.origin;
  features.viewpoint = finer.viewpoint;
  features.voxel_size = 2 * finer.voxel_size;
  // The corner of the finer voxels' grid is not known here, but any point that moves with the cloud serves.
  features.points = voxel_centroids(finer.fine_points, Eigen::Vector3d::Zero(), features.voxel_size);
  features.fine_points = finer.points;
  features.cloud_points = finer.cloud_points;
  features.stray = finer.stray;
  for (const ScannedPart& part : finer.parts) {
    features.parts.push_back({part.viewpoint, voxel_centroids(part.fine_points, Eigen::Vector3d::Zero(),
                                                              fine_voxels * features.voxel_size)});
  }
  return features;
}

}  // namespace igsp
