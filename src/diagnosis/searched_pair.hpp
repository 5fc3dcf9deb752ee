#pragma once

#include "igsp/features.hpp"
#include "igsp/result.hpp"

namespace igsp {

/// A refused pair, described once for all causes that are searched for. Whether there is an answer is asked, not how
/// exact it is: where enough voxels are left, they are twice as large as those of the refused answer.
struct SearchedPair {
  SearchedPair(const Scan& source, const Scan& target, const Result& refused, const ProgressCallback& progress);
  Options options;  ///< at that voxel size, with fewer hypotheses than usual
  Features source, target;
};

}  // namespace igsp
