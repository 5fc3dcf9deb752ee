#pragma once

#include "igsp/features.hpp"
#include "igsp/options.hpp"
#include "igsp/point_cloud.hpp"
#include "igsp/progress.hpp"
#include "igsp/result.hpp"

namespace igsp {

/// The easy door: the rigid transformation that puts `source` onto `target`, without an initial guess, and whether to
/// believe it. Points in one common unit; where a scanner's viewpoint is known, the space that it saw through counts as
/// evidence. Throws InvalidArgument (empty cloud, non-finite point or viewpoint, option out of range) and Cancelled; a
/// pair that cannot be registered is a Result that says so.
Result align(const Scan& source, const Scan& target, const Options& options = {},
             const ProgressCallback& progress = {});

/// From an initial guess of target_from_source: it is checked and refined if it holds; there is no search.
Result align(const Scan& source, const Scan& target, const Transformation& initial, const Options& options = {},
             const ProgressCallback& progress = {});

/// The staged door: both feature sets must share one voxel size and the feature options.
Result align(const Features& source, const Features& target, const Options& options = {},
             const ProgressCallback& progress = {});

Result align(const Features& source, const Features& target, const Transformation& initial, const Options& options = {},
             const ProgressCallback& progress = {});

}  // namespace igsp
