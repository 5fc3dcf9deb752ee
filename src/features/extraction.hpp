#pragma once

#include "core/stage_clock.hpp"
#include "igsp/features.hpp"
#include "spatial/trimmed_cloud.hpp"

namespace igsp {

/// Throws InvalidArgument.
void require_finite(const std::optional<Eigen::Vector3d>& viewpoint);

enum class Description { now, later };

/// extract_features for a cloud whose stray points are known already, and with a finite viewpoint. Normals, keypoints and
/// all that belongs to them may be left out until they are needed.
Features extract_features(const TrimmedCloud& cloud, const std::optional<Eigen::Vector3d>& viewpoint,
                          const Options& options, const ProgressCallback& progress,
                          Description description = Description::now);

/// What was left out, if it was.
void complete(const Options& options, StageClock& clock, Features& features);

/// The same cloud at voxels twice as large, from its finer ones.
Features coarser_features(const Features& finer, const Options& options, const ProgressCallback& progress);

/// What a plane mirror at the local origin shows, x being negated: the same keypoints, described anew.
Features mirrored_features(const Features& features, const Options& options);

}  // namespace igsp
