#pragma once

#include <functional>
#include <span>
#include <vector>

#include "registration/common_frame.hpp"
#include "registration/hypotheses.hpp"

namespace igsp {

/// Matches proposals again in their common frame, those with most agreeing matches first. A clear winner spares the
/// others, except those with half of its inliers, which would be the other poses of a symmetric scene. `tick`: the
/// share that is done.
std::vector<Rematch> screen(CommonFrame& frame, std::span<const Hypothesis> hypotheses, const Options& options,
                            const std::function<void(double)>& tick);

}  // namespace igsp
