#include "features/keypoints.hpp"

#include <algorithm>

namespace igsp {

std::vector<std::uint32_t> detect_keypoints(PointView points, const PointGrid& grid, const LocalPca& pca,
                                            double voxel_size, const KeypointOptions& options) {
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const bool kept = pca.ratio21[i] < options.max_eigenvalue_ratio && pca.ratio32[i] < options.max_eigenvalue_ratio &&
                      pca.neighbours[i] > static_cast<std::uint32_t>(options.min_neighbours) &&
                      pca.curvature[i] >= options.min_curvature;
    if (kept) candidates.push_back(i);
  }
  std::sort(candidates.begin(), candidates.end(), [&](std::uint32_t a, std::uint32_t b) {
    return pca.curvature[a] != pca.curvature[b] ? pca.curvature[a] > pca.curvature[b] : a < b;
  });

  std::vector<char> suppressed(points.size(), 0);
  std::vector<std::uint32_t> keypoints;
  const float radius = static_cast<float>(options.suppression_radius * voxel_size);
  for (const std::uint32_t candidate : candidates) {
    if (suppressed[candidate]) continue;
    keypoints.push_back(candidate);
    grid.visit_sphere(points[candidate].cast<float>(), radius,
                      [&](std::uint32_t i, float) { suppressed[grid.index[i]] = 1; });
  }
  return keypoints;
}

}  // namespace igsp
