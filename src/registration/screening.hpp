#pragma once

#include <functional>
#include <span>
#include <vector>

#include "registration/common_frame.hpp"
#include "registration/hypotheses.hpp"

namespace igsp {

/// Is the space empty that the scanners saw through, if a pose is right? Not given where no viewpoint is known.
using FreeSpaceQuestion = std::function<FreeSpace(const Transformation&)>;

/// Matches proposals again in their common frame, those with most agreeing matches first, in the light of free space
/// where that is known. A clear winner spares the others, except those with half of its inliers, which would be the
/// other poses of a symmetric scene. `tick`: the share that is done.
std::vector<Rematch> screen(CommonFrame& frame, std::span<const Hypothesis> hypotheses, const Options& options,
                            const FreeSpaceQuestion& ask_free_space, const std::function<void(double)>& tick);

}  // namespace igsp
