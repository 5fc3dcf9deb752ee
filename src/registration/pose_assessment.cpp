#include "registration/pose_assessment.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/robust_fit.hpp"
#include "features/bsc.hpp"
#include "matching/hamming.hpp"

namespace igsp {
namespace {

constexpr double agreeing_distance = 2.5;      // voxels
constexpr double on_surface = 1.5;             // voxels
constexpr std::uint16_t same_place_bits = 95;  // true places differ by 56..92 bits in the common frame, others by 170
constexpr std::size_t max_samples = 200;
constexpr double chance_matches = 3.0;      // mutual matches that agree with a wrong pose now and then
constexpr double expected_agreement = 0.8;  // share of mutual matches that agree, over overlap: right poses have more

// Keypoints of one cloud, mapped onto the other: how many lie on its surface, and how many of those look the same there.
// `axes` are the common frame's axes in the coordinates of `other`. Counts are scaled up from at most 200 samples.
struct Recognised {
  double on_surface = 0;
  double alike = 0;
};

Recognised recognised_keypoints(PointView keypoints, std::span<const Descriptor> descriptors,
                                const PreparedCloud& other, const Transformation& other_from_own,
                                const Eigen::Matrix3d& axes, double radius) {
  const std::size_t stride = std::max<std::size_t>(1, (keypoints.size() + max_samples - 1) / max_samples);
  std::size_t sampled = 0;
  Recognised counts;
  Support support;
  for (std::size_t i = 0; i < keypoints.size(); i += stride) {
    ++sampled;
    const Eigen::Vector3d place = other_from_own * keypoints[i];
    const float reach = static_cast<float>(on_surface * other.features.voxel_size);
    if (other.grid.nearest(place.cast<float>(), reach) < 0) continue;
    gather_support(other.grid, place, radius, support);
    const Descriptor there = binary_shape_context(support, axes, radius);
    ++counts.on_surface;
    counts.alike += feature_distance({&there, 1}, descriptors[i]) < same_place_bits;
  }
  const double scale = sampled > 0 ? static_cast<double>(keypoints.size()) / static_cast<double>(sampled) : 0.0;
  return {counts.on_surface * scale, counts.alike * scale};
}

struct BothWays {
  Recognised source_on_target;
  Recognised target_on_source;
};

BothWays recognised_both_ways(CommonFrame& frame, const Transformation& target_from_source) {
  const Eigen::Matrix3d& rotation = target_from_source.linear();
  const double radius = frame.descriptor_radius();
  return {recognised_keypoints(frame.source().keypoints, frame.source_descriptors(rotation), frame.target(),
                               target_from_source, Eigen::Matrix3d::Identity(), radius),
          recognised_keypoints(frame.target().keypoints, frame.target_descriptors(), frame.source(),
                               target_from_source.inverse(), rotation.transpose(), radius)};
}

double quality_of(const PoseAssessment& pose) {
  const double s = std::sqrt(pose.source_on_target.share * pose.target_on_source.share);
  const double mutual = std::max(1.0, static_cast<double>(pose.mutual_matches));
  const double agreeing = static_cast<double>(pose.agreeing_matches);
  const double overlap = std::min(pose.source_on_target.overlap, pose.target_on_source.overlap);
  const double beyond_chance = std::max(agreeing - chance_matches, 0.0) + 0.1;
  // Where much overlaps much must agree: the same architecture elsewhere lies well on itself, yet few features agree.
  const double missing = (agreeing + 0.1) / mutual / (expected_agreement * std::max(overlap, 0.02));
  return 1.5 * std::log10(s / (1 - s)) + std::log10(beyond_chance / mutual) + 2.0 * std::log10(std::min(1.0, missing));
}

double recognised_share(const Recognised& r) { return (r.alike + 0.5) / (r.on_surface + 1.0); }

}  // namespace

double ranking_score(CommonFrame& frame, const Transformation& target_from_source) {
  const BothWays recognised = recognised_both_ways(frame, target_from_source);
  const auto matches = mutual_matches(frame, target_from_source.linear());
  const std::size_t agreeing =
      count_inliers(matches, target_from_source, agreeing_distance * frame.target().features.voxel_size);
  return std::sqrt(recognised.source_on_target.alike * recognised.target_on_source.alike) *
         static_cast<double>(agreeing);
}

PoseAssessment assess_pose(CommonFrame& frame, const Transformation& target_from_source) {
  PoseAssessment assessment;
  assessment.source_on_target = surface_contact(frame.source(), frame.target(), target_from_source);
  assessment.target_on_source = surface_contact(frame.target(), frame.source(), target_from_source.inverse());
  const auto matches = mutual_matches(frame, target_from_source.linear());
  assessment.mutual_matches = matches.size();
  assessment.agreeing_matches =
      count_inliers(matches, target_from_source, agreeing_distance * frame.target().features.voxel_size);
  const BothWays recognised = recognised_both_ways(frame, target_from_source);
  assessment.recognised_share = std::sqrt(recognised_share(recognised.source_on_target) *
                                          recognised_share(recognised.target_on_source));
  assessment.quality = quality_of(assessment);
  return assessment;
}

}  // namespace igsp
