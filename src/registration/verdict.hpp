#pragma once

#include "igsp/result.hpp"
#include "registration/coarser_scale.hpp"
#include "registration/search.hpp"

namespace igsp {

/// Fills the verdict, its reason, overlap and RMSE of `result` from the pose that a search found. Where the scale that
/// settled the search does not carry it, the other one is asked as well: sparse surfaces close at the coarser.
void judge(FinerScale& finer, CoarserScale& coarser, const SearchOutcome& outcome, Result& result);

}  // namespace igsp
