#pragma once

#include "registration/scale_ladder.hpp"
#include "registration/verdict.hpp"

namespace igsp {

/// Where the answer is not beyond doubt, the mirror image has to do worse: floor and walls lie right in a mirror, too.
/// Else the pair is refused, and the confidence is the answer's share of both.
void compare_with_mirror_image(const Features& source, const Features& target, const CompleteBoth& complete_both,
                               StageClock& clock, Doubts& doubts, Result& result);

}  // namespace igsp
