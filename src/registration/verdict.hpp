#pragma once

#include "igsp/result.hpp"
#include "registration/coarser_scale.hpp"
#include "registration/search.hpp"

namespace igsp {

/// Fills the verdict, its reason, overlap and RMSE of `result` from the pose that a search found. Where the scale of
/// the frame does not carry it, the coarser one is asked as well: sparse surfaces close there.
void judge(CommonFrame& frame, CoarserScale& coarser, const SearchOutcome& outcome, Result& result);

}  // namespace igsp
