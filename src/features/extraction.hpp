#pragma once

#include "igsp/features.hpp"
#include "spatial/trimmed_cloud.hpp"

namespace igsp {

/// Throws InvalidArgument.
void require_finite(const std::optional<Eigen::Vector3d>& viewpoint);

/// extract_features for a cloud whose stray points are known already, and with a finite viewpoint.
Features extract_features(const TrimmedCloud& cloud, const std::optional<Eigen::Vector3d>& viewpoint,
                          const Options& options, const ProgressCallback& progress);

}  // namespace igsp
