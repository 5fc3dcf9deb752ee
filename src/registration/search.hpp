#pragma once

#include <vector>

#include "core/stage_clock.hpp"
#include "igsp/result.hpp"
#include "registration/common_frame.hpp"

namespace igsp {

/// What a search hands to the verdict, in the clouds' local coordinates.
struct SearchOutcome {
  Termination termination = Termination::too_few_matches;
  bool has_estimate = false;
  Transformation target_from_source = Transformation::Identity();
  std::vector<IterationRecord> iterations;
  std::vector<Transformation> rivals;  ///< other hypotheses that were refined as well
};

/// The paper: Algorithm 1 from feature distance alone.
SearchOutcome direct_search(const CommonFrame& frame, const Options& options, StageClock& clock);

/// Hypotheses from geometric consistency; screened, refined and ranked in a common frame; the best one through the
/// hybrid loop to the end and, if asked for, point-to-plane refinement.
SearchOutcome hypotheses_search(CommonFrame& frame, const Options& options, StageClock& clock);

}  // namespace igsp
