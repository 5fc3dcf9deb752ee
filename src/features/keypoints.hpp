#pragma once

#include <vector>

#include "igsp/options.hpp"
#include "spatial/local_pca.hpp"

namespace igsp {

/// Curvature keypoints: points whose eigenvalue ratios, neighbour count and surface variation pass the options, thinned
/// by non-maximum suppression: by curvature descending (ties by index), take the best one left, drop all within r_k.
/// Returns indices in that order. After Zhong 2009 (Intrinsic Shape Signatures), ranked by surface variation.
std::vector<std::uint32_t> detect_keypoints(PointView points, const PointGrid& grid, const LocalPca& pca,
                                            double voxel_size, const KeypointOptions& options);

}  // namespace igsp
