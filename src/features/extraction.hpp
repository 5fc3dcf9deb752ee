#pragma once

#include "core/stage_clock.hpp"
#include "igsp/features.hpp"
#include "spatial/trimmed_scan.hpp"

namespace igsp {

/// When normals, keypoints and what belongs to them are made.
enum class Keypoints { now, later };

/// extract_features for a scan whose stray points are known already. What is left for later is made by `complete`.
Features extract_features(const TrimmedScan& scan, const Options& options, const ProgressCallback& progress,
                          Keypoints keypoints = Keypoints::now);

/// Makes what was left for later, if it was.
void complete(const Options& options, StageClock& clock, Features& features);

/// The same cloud at voxels twice as large, from its finer ones, normals and keypoints being left for later.
Features coarser_voxels(const Features& finer);

/// What a plane mirror at the local origin shows, x being negated: the same keypoints, described anew.
Features mirrored_features(const Features& features, const Options& options);

}  // namespace igsp
