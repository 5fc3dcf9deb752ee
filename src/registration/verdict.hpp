#pragma once

#include "igsp/result.hpp"
#include "registration/search.hpp"

namespace igsp {

/// Fills the verdict, its reason, overlap and RMSE of `result` from the pose that a search found.
void judge(CommonFrame& frame, const SearchOutcome& outcome, Result& result);

}  // namespace igsp
