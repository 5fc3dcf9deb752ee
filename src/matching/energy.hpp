#pragma once

#include <optional>
#include <span>
#include <vector>

#include "igsp/features.hpp"
#include "igsp/options.hpp"
#include "igsp/point_cloud.hpp"
#include "matching/assignment.hpp"

namespace igsp {

/// Weights of feature and Euclidean distance at iteration k (Eq. 7): they sum to 1.
struct EnergyWeights {
  double fd;  ///< W_fd = exp(-k / m)
  double ed;  ///< W_ed = 1 - W_fd
};
EnergyWeights energy_weights(int k, double weight_changing_rate);

/// The two keypoint sets as the energy sees them, the source already moved by the current transformation.
struct KeypointSets {
  PointView source;                             ///< m positions
  PointView target;                             ///< n positions
  std::span<const Descriptor> source_variants;  ///< m x variants, row-major
  int variants = 4;
  std::span<const Descriptor> target_descriptors;  ///< n
};

/// A correspondence with the two distances its energy is made of.
struct Correspondence {
  std::uint32_t source;
  std::uint32_t target;
  double feature_distance;    ///< FD, Eq. 4 [bits]
  double euclidean_distance;  ///< |p - q| [units of the cloud], not scaled
};

/// Mean and sigma of the feature distance over all m x n pairs: mu_cd and sigma_cd of Eq. 11 at k = 0, where W_ed = 0.
struct DistanceSpread {
  double mean;
  double sigma;
};
DistanceSpread feature_distance_spread(const KeypointSets& keypoints, int threads);

/// The same of CD at k > 0, where the released rule wants it once; the work is m x n.
DistanceSpread compound_distance_spread(const KeypointSets& keypoints, double ed_scale, const EnergyWeights& weights,
                                        int threads);

/// T_cd at k = 0 (Eq. 11, read as mean minus p1 sigma).
double initial_threshold(const DistanceSpread& spread, const EnergyOptions& options);

/// T_cd at k > 0 from the correspondences of k - 1, their distances taken after its transformation. `ed_scale` is s_ed.
/// Keeps `previous` when nothing was matched; never below options.min_threshold.
double next_threshold(std::span<const Correspondence> matched, double ed_scale, const EnergyWeights& weights,
                      double previous, const EnergyOptions& options);

/// All pairs with CD < threshold (Eq. 2-4), sorted, costs in assignment units.
std::vector<AssignmentEdge> candidate_edges(const KeypointSets& keypoints, double ed_scale,
                                            const EnergyWeights& weights, double threshold, int threads);

/// The correspondences of an assignment, with their distances.
std::vector<Correspondence> correspondences_of(const Assignment& assignment, const KeypointSets& keypoints);

/// Recomputes the Euclidean distances after the source moved.
void update_distances(std::span<Correspondence> correspondences, const KeypointSets& keypoints);

/// E of Eq. 1, with W_p = T_cd / 2 for every unmatched keypoint of both sets [bits].
double matching_energy(const Assignment& assignment, const KeypointSets& keypoints, double threshold);

}  // namespace igsp
