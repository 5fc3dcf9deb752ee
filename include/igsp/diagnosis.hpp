#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "igsp/point_cloud.hpp"
#include "igsp/progress.hpp"
#include "igsp/result.hpp"

namespace igsp {

/// What about the clouds themselves stands in the way of a registration.
enum class Cause {
  too_few_points,      ///< too few for a surface
  flat,                ///< all points lie on one plane or line, such as z = 0 everywhere
  degrees,             ///< longitude and latitude beside heights
  coarse_coordinates,  ///< coordinates in steps that are no longer small against a voxel
  mirrored,            ///< one of the clouds is left-handed
  scale,               ///< one of the clouds has another unit of length, or is measured too long
};
std::string_view to_string(Cause cause);

struct Diagnosis {
  Cause cause = Cause::too_few_points;
  std::string description;  ///< one sentence: the cause, how it was seen, the remedy
  /// What would register, p_target = (matrix * (p_source, 1)): with a reflection where mirrored, a factor where the
  /// scale differs. None: not looked for.
  std::optional<Eigen::Matrix4d> target_from_source;
};

struct DiagnosisOptions {
  bool search = true;  ///< also look whether the source would register mirrored or in another scale; false: only look
                       ///< at the coordinates
};

/// Why `refused`, the answer to this pair, may have been refused; the options are those of that answer. Most likely
/// first; empty if nothing was found, as for clouds that simply do not overlap, and for a registered pair. Throws
/// InvalidArgument (empty cloud, non-finite point) and Cancelled.
std::vector<Diagnosis> diagnose(const Scan& source, const Scan& target, const Result& refused,
                                const DiagnosisOptions& options = {}, const ProgressCallback& progress = {});

}  // namespace igsp
