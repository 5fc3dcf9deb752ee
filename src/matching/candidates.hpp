#pragma once

#include <span>
#include <vector>

#include "igsp/features.hpp"
#include "igsp/point_cloud.hpp"

namespace igsp {

/// A putative correspondence with the rotation that its two local reference frames imply.
struct Candidate {
  std::uint32_t source;
  std::uint32_t target;
  float score;                            ///< how far FD stands out in its row and its column, in sigmas
  Eigen::Quaternionf target_from_source;  ///< from frame to frame, with the sign variant of least FD
};

/// The keypoints of one cloud with everything that matching needs.
struct DescribedKeypoints {
  PointView positions;
  std::span<const Eigen::Matrix3d> frames;
  std::span<const Descriptor> descriptors;
};

/// The union of the `per_keypoint` best by feature distance from both sides, the `max_candidates` that stand out most:
/// (mean_row - FD) / sigma_row + (mean_column - FD) / sigma_column. Best first.
std::vector<Candidate> feature_candidates(const DescribedKeypoints& source, const DescribedKeypoints& target,
                                          int variants, int per_keypoint, int max_candidates, int threads);

}  // namespace igsp
