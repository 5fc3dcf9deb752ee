#pragma once

#include <vector>

#include "core/stage_clock.hpp"
#include "igsp/result.hpp"
#include "registration/common_frame.hpp"
#include "registration/rivals.hpp"
#include "registration/scale_ladder.hpp"

namespace igsp {

/// What a search hands to the verdict, in the clouds' local coordinates.
struct SearchOutcome {
  Termination termination = Termination::too_few_matches;
  bool has_estimate = false;
  Transformation target_from_source = Transformation::Identity();
  std::vector<IterationRecord> iterations;
  std::vector<std::vector<Rival>> ranked;  ///< by rung, where that was searched: its poses, best first
  std::size_t rung = 0;                    ///< of the scale ladder, that answered
  std::size_t finest_rung = 0;             ///< that was searched
  bool is_hopeful = true;                  ///< the answer; one that is not gets fewer points of the fine registration
  double contradiction = 0;                ///< odds against the answer of what finer rungs found, if they weigh; else 0
  Precision precision;                     ///< in the target's local coordinates
};

/// The paper: Algorithm 1 from feature distance alone.
SearchOutcome direct_search(const CommonFrame& frame, const Options& options, StageClock& clock);

/// Hypotheses from geometric consistency, screened in a common frame, refined and ranked; on the coarsest rung of the
/// ladder first and from there down, the best of a rung being ranked on the next as well, until one settles the pair or
/// shows that it is hopeless. The answer of the most confident rung goes through the hybrid loop to the end and, if
/// asked for, point-to-plane refinement.
SearchOutcome hypotheses_search(ScaleLadder& scales, const Options& options, StageClock& clock);

/// From an initial guess: no search, only the hybrid loop and the refinement; the verdict tells whether it held.
SearchOutcome refine_initial(ScaleLadder& scales, const Transformation& initial, const Options& options,
                             StageClock& clock);

}  // namespace igsp
