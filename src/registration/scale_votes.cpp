#include "registration/scale_votes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "features/extraction.hpp"
#include "spatial/scale.hpp"

namespace igsp {
namespace {

constexpr double min_length = 8.0;        // voxels
constexpr double peak_prominence = 6.0;   // of 13 pairs without overlap, two voxel sizes each, one vote is above
constexpr double same_factor = 0.15;      // of the logarithm: seen in voxels of the same size
constexpr double most_ratio_apart = 0.7;  // of the logarithm, from the ratio of the clouds' own voxel sizes
constexpr double widening = 1.4;          // steps between sizes that are tried around the clouds' own

Points keypoints_of(const Features& features, double factor) {
  Points keypoints;
  for (const std::uint32_t i : features.keypoints) keypoints.push_back(factor * features.points[i]);
  return keypoints;
}

double own_voxel_size(const TrimmedCloud& cloud, const Options& options) {
  ScaleOptions own = options.scale;
  own.voxel_size = 0;
  return choose_voxel_size(cloud, cloud, own);
}

// Where both scans show about the same, their own voxels are as far apart as their units.
std::vector<double> expected_factors(double own_ratio) {
  std::vector<double> factors;
  for (const double factor : {1.0, own_ratio, own_ratio * widening, own_ratio / widening}) {
    const bool seen =
        std::ranges::any_of(factors, [&](double other) { return std::abs(std::log(factor / other)) < same_factor; });
    const bool too_far = std::abs(std::log(factor / own_ratio)) > most_ratio_apart;
    if (!seen && !too_far) factors.push_back(factor);
  }
  return factors;
}

}  // namespace

ScaledScan::ScaledScan(const Scan& scan, double factor)
    : points(scan.points.begin(), scan.points.end()), parts(scan.parts) {
  for (Eigen::Vector3d& point : points) point *= factor;
  if (scan.viewpoint) viewpoint = factor * *scan.viewpoint;
  for (ScanPart& part : parts) {
    if (part.viewpoint) *part.viewpoint *= factor;
  }
}

Scan ScaledScan::scan() const {
  Scan scan(points, viewpoint);
  scan.parts = parts;
  return scan;
}

RatioPeak scale_vote(const Features& source, const Features& target, double expected, const Options& options) {
  const Points moving = keypoints_of(source, expected), fixed = keypoints_of(target, 1.0);
  const auto candidates =
      feature_candidates({moving, source.frames, source.descriptors}, {fixed, target.frames, target.descriptors},
                         options.degrees_of_freedom == 4 ? 2 : 4, options.hypotheses.candidates_per_keypoint,
                         options.hypotheses.max_candidates, options.threads);
  RatioPeak peak = ratio_peak(candidates, moving, fixed, min_length * target.voxel_size);
  peak.factor *= expected;
  return peak;
}

std::vector<double> voted_factors(const Scan& source, const Scan& target, const Options& options,
                                  const ProgressCallback& progress) {
  const TrimmedScan moving(source.points, "source"), fixed(target.points, "target");  // viewpoints say nothing here
  if (!(moving.cloud.bounds().diagonal() > 0) || !(fixed.cloud.bounds().diagonal() > 0)) return {};
  const double source_size = own_voxel_size(moving.cloud, options), target_size = own_voxel_size(fixed.cloud, options);
  Options scaled = options;
  const auto features_at = [&](const TrimmedScan& scan, double voxel_size) {
    scaled.scale.voxel_size = voxel_size;
    return extract_features(scan, scaled, progress, Described::at_one_scale);
  };
  const Features target_features = features_at(fixed, target_size);
  std::vector<RatioPeak> peaks;
  for (const double expected : expected_factors(target_size / source_size)) {
    const Features source_features = features_at(moving, target_size / expected);
    const RatioPeak peak = scale_vote(source_features, target_features, expected, options);
    if (peak.prominence >= peak_prominence) peaks.push_back(peak);
  }
  std::ranges::stable_sort(peaks, std::greater(), &RatioPeak::prominence);
  std::vector<double> factors;
  for (const RatioPeak& peak : peaks) factors.push_back(peak.factor);
  return factors;
}

}  // namespace igsp
