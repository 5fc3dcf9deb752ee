#pragma once

#include "igsp/align.hpp"

namespace igsp {

/// A rigid motion and one factor of scale, seven degrees of freedom:
/// p_target = result.target_from_source * (factor * p_source).
struct SimilarityResult {
  double factor = 1.0;  ///< by which the source was multiplied
  double sigma = 0.0;   ///< standard deviation of the factor, from the residuals; 0 where nothing was registered
  Result result;        ///< of the source after that, in the target's unit
  Eigen::Matrix4d matrix() const;  ///< both: p_target = matrix * (p_source, 1); no rigid motion unless the factor is 1
};

/// For clouds of which one has no or another unit of length: meshes from photographs, feet beside metres, a scanner
/// that measures a few percent too long. The factor is voted for by the lengths between candidate correspondences,
/// whatever its size, and estimated with the pose by point-to-plane registration. Where nothing registers the factor is
/// near 1, from what was tried first. Costs as much as several calls of `align`. Throws as `align` does;
/// options.scale.voxel_size is the target's.
SimilarityResult align_similarity(const Scan& source, const Scan& target, const Options& options = {},
                                  const ProgressCallback& progress = {});

}  // namespace igsp
