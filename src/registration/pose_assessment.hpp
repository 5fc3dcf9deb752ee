#pragma once

#include "registration/common_frame.hpp"
#include "registration/surface_contact.hpp"

namespace igsp {

/// What the clouds themselves say of a pose: two independent questions.
struct PoseAssessment {
  SurfaceContact source_on_target;  ///< do the surfaces lie on each other wherever they meet?
  SurfaceContact target_on_source;
  std::size_t mutual_matches = 0;    ///< do the features agree? Mutual nearest neighbours in the common frame ...
  std::size_t agreeing_matches = 0;  ///< ... and those of them within 2.5 voxels
  double quality = 0;                ///< Q, docs/method.md
  /// Share of the mutual matches that agree, in terms of what right poses of such an overlap have at least.
  double share_of_expected() const;
};
PoseAssessment assess_pose(CommonFrame& frame, const Transformation& target_from_source);

}  // namespace igsp
