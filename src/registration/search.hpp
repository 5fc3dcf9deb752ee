#pragma once

#include <vector>

#include "core/stage_clock.hpp"
#include "igsp/result.hpp"
#include "registration/coarser_scale.hpp"
#include "registration/common_frame.hpp"
#include "registration/finer_scale.hpp"
#include "registration/pose_assessment.hpp"

namespace igsp {

/// A refined hypothesis that lost.
struct Rival {
  Transformation target_from_source;
  PoseAssessment assessment;
};

/// What a search hands to the verdict, in the clouds' local coordinates.
struct SearchOutcome {
  Termination termination = Termination::too_few_matches;
  bool has_estimate = false;
  Transformation target_from_source = Transformation::Identity();
  std::vector<IterationRecord> iterations;
  std::vector<Rival> rivals;    ///< other poses, best first
  bool settled_coarse = false;  ///< at the coarser scale, which the rivals are assessed at
  Precision precision;          ///< in the target's local coordinates
};

/// The paper: Algorithm 1 from feature distance alone.
SearchOutcome direct_search(const CommonFrame& frame, const Options& options, StageClock& clock);

/// Hypotheses from geometric consistency, screened in a common frame, refined and ranked; at the coarser scale first
/// and, where that does not settle it, at the finer one, where the best of the coarser are ranked as well. The best one
/// through the hybrid loop to the end and, if asked for, point-to-plane refinement.
SearchOutcome hypotheses_search(FinerScale& finer, CoarserScale& coarser, const Options& options, StageClock& clock);

/// From an initial guess: no search, only the hybrid loop and the refinement; the verdict tells whether it held.
SearchOutcome refine_initial(FinerScale& finer, const Transformation& initial, const Options& options,
                             StageClock& clock);

}  // namespace igsp
