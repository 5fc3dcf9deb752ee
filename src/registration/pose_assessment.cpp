#include "registration/pose_assessment.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "estimation/robust_fit.hpp"
#include "registration/free_space.hpp"

namespace igsp {
namespace {

constexpr double agreeing_distance = 2.5;  // voxels
// Log odds of 1 right to 1 wrong answer: docs/verdict.md tells how they were fitted.
constexpr double contact_weight = 2.0, missing_weight = 5.0, even = 4.4;
constexpr double most_contact = 0.97;       // wrong poses of like surfaces come as near; more says no more
constexpr double expected_agreement = 0.7;  // share of mutual matches that agree, over overlap: right poses have more

// Of the two questions that need no viewpoint.
double quality_of(const PoseAssessment& pose) {
  const double s = std::min(most_contact, pose.contact());
  const auto agreeing = static_cast<double>(pose.agreeing_matches);
  // Where much overlaps much must agree: the same architecture elsewhere lies well on itself, yet few features agree.
  return contact_weight * std::log10(s / (1 - s)) + matches_weight * std::log10(agreeing + 1) +
         missing_weight * std::log10(std::min(1.0, pose.share_of_expected())) - even;
}

// Rooms are like rooms: their wrong poses overlap by a half and more, with contact and matches that would carry a right
// pose of a third. Right ones of that overlap have more of both.
constexpr double undemanding_overlap = 0.4, demanding_overlap = 0.7, decades_per_overlap = 3.0;

// Large voxels show little but walls and ground. Where a few features agree there, and finer voxels do not carry the
// answer, as many poses are wrong as right.
constexpr double few_agreeing = 10, safe_agreeing = 13, decades_for_few = 1.0;

// Free space confirms what contact and matches say, not in place of them: that is little on large voxels, nothing for
// the first number of them and all for the second, and where surfaces cross. Whatever was registered before it weighed
// so much touched at 0.8 and more (docs/decisions, 15).
constexpr double few_voxels = 300, many_voxels = 3000;
constexpr double crossing = 0.7, lying = 0.8;

double weight_of_free_space(const PoseAssessment& pose, const CommonFrame& frame) {
  const double voxels = std::sqrt(static_cast<double>(frame.source().features.points.size()) *
                                  static_cast<double>(frame.target().features.points.size()));
  return std::clamp(std::log(voxels / few_voxels) / std::log(many_voxels / few_voxels), 0.0, 1.0) *
         std::clamp((pose.contact() - crossing) / (lying - crossing), 0.0, 1.0);
}

}  // namespace

double PoseAssessment::contact() const {
  return std::sqrt(source_on_target.share * target_on_source.share);
}

double PoseAssessment::overlap() const {
  return std::sqrt(source_on_target.overlap * target_on_source.overlap);
}

double PoseAssessment::share_of_expected() const {
  const double share =
      (static_cast<double>(agreeing_matches) + 0.1) / std::max(1.0, static_cast<double>(mutual_matches));
  return share / (expected_agreement * std::max(overlap(), 0.02));
}

double demanded_quality(const PoseAssessment& pose, std::size_t rung) {
  const double for_overlap =
      decades_per_overlap * (std::clamp(pose.overlap(), undemanding_overlap, demanding_overlap) - undemanding_overlap);
  if (rung == 0) return for_overlap;
  const double agreeing = std::clamp(static_cast<double>(pose.agreeing_matches), few_agreeing, safe_agreeing);
  return for_overlap + decades_for_few * (safe_agreeing - agreeing) / (safe_agreeing - few_agreeing);
}

double PoseAssessment::chance_odds() const {
  return std::pow(10.0, demanded - quality);
}

PoseAssessment assess_pose(ScaleLadder& scales, std::size_t rung, const Transformation& target_from_source,
                           int threads) {
  CommonFrame& frame = scales.frame(rung);
  PoseAssessment assessment;
  parallel_pair(
      threads,
      [&] { assessment.source_on_target = surface_contact(frame.source(), frame.target(), target_from_source); },
      [&] {
        assessment.target_on_source = surface_contact(frame.target(), frame.source(), target_from_source.inverse());
      });
  const auto matches = mutual_matches(frame, target_from_source.linear(), threads);
  assessment.mutual_matches = matches.size();
  assessment.agreeing_matches =
      count_inliers(matches, target_from_source, agreeing_distance * frame.target().features.voxel_size);
  assessment.free_space = scales.space().at(target_from_source);
  assessment.free_space_evidence =
      scales.space().evidence(assessment.free_space, weight_of_free_space(assessment, frame));
  assessment.quality = quality_of(assessment) + assessment.free_space_evidence;
  assessment.demanded = demanded_quality(assessment, rung);
  return assessment;
}

}  // namespace igsp
