#pragma once

#include <functional>
#include <vector>

#include "registration/igsp_loop.hpp"
#include "registration/scale_ladder.hpp"

namespace igsp {

/// The hybrid loop in a common frame from `initial` on, with descriptors of the source in axes near those of that pose.
LoopOutcome hybrid_loop(CommonFrame& frame, const std::vector<Descriptor>& source_descriptors,
                        const Transformation& initial, int iterations, const Options& options,
                        const std::function<void(int)>& tick = {});

/// A short refinement on the voxel centroids, before hypotheses are compared.
Transformation settle(const Surface& source, const Surface& target, const Transformation& initial, double voxel_size,
                      const Options& options);

/// A pose that was found on a rung, down to the noise of the scanner on the finer voxels; with a quarter of the points
/// where it is not hopeful.
Transformation refined(ScaleLadder& scales, std::size_t rung, const Transformation& target_from_source,
                       const Options& options, bool is_hopeful = true);

}  // namespace igsp
