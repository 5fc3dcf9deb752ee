#include "registration/common_frame.hpp"

#include <array>

#include "estimation/robust_fit.hpp"
#include "features/bsc.hpp"
#include "igsp/evaluation.hpp"
#include "matching/hamming.hpp"

namespace igsp {
namespace {

constexpr double reuse_angle_rad = 2.0 * M_PI / 180.0;
constexpr double agreeing_distance = 2.5;                        // voxels
constexpr std::array<double, 2> mode_radii{4.0, 8.0};            // voxels
constexpr std::array<double, 4> fit_scales{4.0, 3.0, 2.0, 2.0};  // voxels

}  // namespace

TranslationMode translation_mode(std::span<const PointPair> matches, const Eigen::Matrix3d& rotation, double radius) {
  Points votes;
  for (const PointPair& match : matches) votes.push_back(match.target - rotation * match.source);
  TranslationMode mode;
  for (const Eigen::Vector3d& vote : votes) {
    std::size_t count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& other : votes) {
      if ((other - vote).squaredNorm() < radius * radius) {
        sum += other;
        ++count;
      }
    }
    if (count > mode.votes) mode = {sum / static_cast<double>(count), count};
  }
  return mode;
}

CommonFrame::CommonFrame(const PreparedCloud& source, const PreparedCloud& target, double descriptor_radius,
                         int threads)
    : source_(source),
      target_(target),
      descriptor_radius_(descriptor_radius),
      threads_(threads),
      source_supports_(gather_supports(source.grid, source.keypoints, descriptor_radius)),
      target_supports_(gather_supports(target.grid, target.keypoints, descriptor_radius)),
      target_descriptors_(describe_target(Eigen::Matrix3d::Identity())) {}

std::vector<Descriptor> CommonFrame::describe_source(const Eigen::Matrix3d& axes) const {
  return describe_in_frame(source_supports_, axes, descriptor_radius_, threads_);
}

std::vector<Descriptor> CommonFrame::describe_target(const Eigen::Matrix3d& axes) const {
  return describe_in_frame(target_supports_, axes, descriptor_radius_, threads_);
}

const std::vector<Descriptor>& CommonFrame::source_descriptors(const Eigen::Matrix3d& target_from_source) {
  for (const Cached& cached : cache_) {
    if (rotation_error_rad(cached.rotation, target_from_source) < reuse_angle_rad) return cached.descriptors;
  }
  // The target's axes, seen in the source: the columns of R^T.
  cache_.push_back({target_from_source, describe_source(target_from_source.transpose())});
  return cache_.back().descriptors;
}

std::vector<PointPair> mutual_matches(CommonFrame& frame, const Eigen::Matrix3d& target_from_source) {
  return mutual_nearest(frame, frame.source_descriptors(target_from_source), frame.target_descriptors());
}

std::vector<PointPair> mutual_nearest(const CommonFrame& frame, std::span<const Descriptor> source,
                                      std::span<const Descriptor> target) {
  const std::size_t m = source.size(), n = target.size();
  if (m == 0 || n == 0) return {};
  const std::vector<std::uint16_t> distance = feature_distance_matrix(source, 1, target, frame.threads());
  std::vector<std::uint32_t> best_of_source(m, 0), best_of_target(n, 0);
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const std::uint16_t d = distance[i * n + j];
      if (d < distance[i * n + best_of_source[i]]) best_of_source[i] = static_cast<std::uint32_t>(j);
      if (d < distance[best_of_target[j] * n + j]) best_of_target[j] = static_cast<std::uint32_t>(i);
    }
  }
  std::vector<PointPair> matches;
  for (std::size_t i = 0; i < m; ++i) {
    const std::uint32_t j = best_of_source[i];
    if (best_of_target[j] == i) matches.push_back({frame.source().keypoints[i], frame.target().keypoints[j]});
  }
  return matches;
}

Rematch rematch(CommonFrame& frame, const Transformation& hypothesis, int degrees_of_freedom) {
  const double voxel_size = frame.target().features.voxel_size;
  const double tolerance = agreeing_distance * voxel_size;
  Rematch best{hypothesis, mutual_matches(frame, hypothesis.linear()), 0};
  best.agreeing = count_inliers(best.matches, hypothesis, tolerance);
  if (best.matches.empty()) return best;
  std::array<double, fit_scales.size()> scales;
  for (std::size_t i = 0; i < scales.size(); ++i) scales[i] = fit_scales[i] * voxel_size;
  for (const double radius : mode_radii) {
    Transformation start = hypothesis;
    start.translation() = translation_mode(best.matches, hypothesis.linear(), radius * voxel_size).translation;
    const auto fit = robust_fit(best.matches, start, scales, degrees_of_freedom);
    if (!fit) continue;
    const std::size_t agreeing = count_inliers(best.matches, *fit, tolerance);
    if (agreeing > best.agreeing) {
      best.agreeing = agreeing;
      best.target_from_source = *fit;
    }
  }
  return best;
}

}  // namespace igsp
