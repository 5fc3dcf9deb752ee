#pragma once

#include "igsp/result.hpp"
#include "registration/scale_ladder.hpp"
#include "registration/surface_contact.hpp"

namespace igsp {

/// Decades of quality for a decade of agreeing matches.
constexpr double matches_weight = 2.0;

/// What the clouds themselves say of a pose: two independent questions, three where a viewpoint is known.
struct PoseAssessment {
  SurfaceContact source_on_target;  ///< do the surfaces lie on each other wherever they meet?
  SurfaceContact target_on_source;
  std::size_t mutual_matches = 0;    ///< do the features agree? Mutual nearest neighbours in the common frame ...
  std::size_t agreeing_matches = 0;  ///< ... and those of them within 2.5 voxels
  FreeSpace free_space;              ///< is empty what the other scanner saw through?
  double free_space_evidence = 0;    ///< of that, F of docs/verdict.md
  double quality = 0;                ///< Q, docs/method.md
  double demanded = 0;               ///< of that, for even odds [decades]
  /// Share of the mutual matches that agree, in terms of what right poses of such an overlap have at least.
  double share_of_expected() const;
  double contact() const;  ///< share, geometric mean of both directions
  double overlap() const;  ///< geometric mean of both directions: one cloud may lie inside the other
  /// Odds that the pose is chance, against that it is right.
  double chance_odds() const;
};

/// Decades of quality that even odds take: more where much overlaps, and where few features agree above rung 0.
double demanded_quality(const PoseAssessment& pose, std::size_t rung);

/// On a rung of the ladder that is ready.
PoseAssessment assess_pose(ScaleLadder& scales, std::size_t rung, const Transformation& target_from_source,
                           int threads);

}  // namespace igsp
