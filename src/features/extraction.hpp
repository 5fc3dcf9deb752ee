#pragma once

#include "igsp/features.hpp"
#include "spatial/trimmed_cloud.hpp"

namespace igsp {

/// Throws InvalidArgument.
void require_finite(const std::optional<Eigen::Vector3d>& viewpoint);

/// extract_features for a cloud whose stray points are known already, and with a finite viewpoint.
Features extract_features(const TrimmedCloud& cloud, const std::optional<Eigen::Vector3d>& viewpoint,
                          const Options& options, const ProgressCallback& progress);

/// The same cloud at voxels twice as large, from its finer ones.
Features coarser_features(const Features& finer, const Options& options);

/// What a plane mirror at the local origin shows, x being negated: the same keypoints, described anew.
Features mirrored_features(const Features& features, const Options& options);

}  // namespace igsp
