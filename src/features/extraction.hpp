#pragma once

#include "core/stage_clock.hpp"
#include "igsp/features.hpp"
#include "spatial/trimmed_scan.hpp"

namespace igsp {

/// How far a cloud is described: its voxels, their normals and keypoints as well, or coarser voxels in the same way.
enum class Described { as_voxels, at_one_scale, at_all_scales };

/// extract_features for a scan whose stray points are known already. Normals and keypoints that are left out are made
/// by `complete`.
Features extract_features(const TrimmedScan& scan, const Options& options, const ProgressCallback& progress,
                          Described described);

/// Makes normals, keypoints and what belongs to them, if they were left out.
void complete(const Options& options, StageClock& clock, Features& features);

/// How many voxel sizes a pair is searched with at most, each twice the one before, and of how many voxels at least
/// coarser ones are made: a quarter of them is left.
constexpr std::size_t most_scales = 4;
constexpr std::size_t enough_voxels_for_coarser = 1200;

/// The same cloud at voxels twice as large, from its finer ones, normals and keypoints being left for later.
Features coarser_voxels(const Features& finer);

/// What a plane mirror at the local origin shows, x being negated: the same keypoints, described anew. Without coarser
/// voxels.
Features mirrored_features(const Features& features, const Options& options);

}  // namespace igsp
