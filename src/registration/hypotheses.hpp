#pragma once

#include <vector>

#include "igsp/options.hpp"
#include "matching/geometric_consistency.hpp"

namespace igsp {

/// A transformation that a set of mutually consistent candidates proposes.
struct Hypothesis {
  Transformation target_from_source;
  std::size_t inliers;  ///< candidates within 2.5 voxels
};

/// Proposals of the consistency graph. Candidates that share most agreeing partners with their neighbours come first;
/// each collects a subset in which everybody agrees with at least three quarters, which is fitted and then refitted
/// robustly over all candidates. Proposals that repeat an earlier one are left out.
std::vector<Hypothesis> propose_hypotheses(std::span<const Candidate> candidates, const ConsistencyGraph& graph,
                                           PointView source, PointView target, double voxel_size,
                                           const Options& options);

/// Whether two transformations say the same of the source: less than 5 degrees and, at `centre`, 4 voxels apart.
bool same_pose(const Transformation& a, const Transformation& b, const Eigen::Vector3d& centre, double voxel_size);

}  // namespace igsp
