#pragma once

#include <string_view>

namespace igsp {

/// How the starting correspondences are found.
enum class Search {
  direct,      ///< the paper: the loop starts from feature distance alone
  hypotheses,  ///< geometric consistency proposes several transformations, ranked in a common frame
};

/// Rule for the mismatch threshold T_cd.
enum class ThresholdRule {
  paper,     ///< Eq. 11 as resolved in docs/method.md
  released,  ///< the rule of the authors' released program: mean minus sigma for k <= 1, RMS and deviation later
};

// Lengths are multiples of the voxel size unless the unit says otherwise. Ranges, units and help texts of every field
// live in one place, src/config/option_list.cpp.

struct ScaleOptions {
  double voxel_size = 0.0;    ///< [units of the cloud]; 0: chosen from both clouds
  int target_points = 12000;  ///< voxel centroids aimed at, geometric mean of both clouds
};

struct KeypointOptions {
  double pca_radius = 6.0;            ///< r_f: sphere of the principal component analysis [voxels]
  double suppression_radius = 3.0;    ///< r_k: non-maximum suppression [voxels]
  double max_eigenvalue_ratio = 1.0;  ///< rho: upper bound of l2/l1 and of l3/l2
  int min_neighbours = 20;            ///< n_min: a keypoint has more neighbours than this
  double min_curvature = 0.01;        ///< c_min: smallest surface variation l3 / (l1 + l2 + l3)
};

struct DescriptorOptions {
  double radius = 7.0;  ///< R: half the side of the Binary Shape Context's grid [voxels]
};

struct EnergyOptions {
  double distance_scale = 30.0;       ///< s_ed = distance_scale / r_k (Eq. 3) [bits per suppression radius]
  double weight_changing_rate = 8.0;  ///< m of Eq. 7 [iterations]
  ThresholdRule threshold_rule = ThresholdRule::paper;
  double p1 = 2.5;             ///< Eq. 11, k = 0: sigmas below the mean
  double p2 = 1.5;             ///< Eq. 11, k > 0: factor of the mean Euclidean distance
  double p3 = 1.25;            ///< Eq. 11, k > 0: factor of the mean feature distance
  double released_p_ed = 1.0;  ///< released rule: factor of the RMS Euclidean distance
  double released_p_fd = 1.0;  ///< released rule: deviations added to the mean feature distance
  double min_threshold = 5.0;  ///< floor of T_cd [bits]
};

/// Search::hypotheses only.
struct HypothesisOptions {
  int candidates_per_keypoint = 3;     ///< best by feature distance, from both sides
  int max_candidates = 2500;           ///< those that stand out most
  double length_tolerance = 2.0;       ///< of two candidates' lengths to agree [voxels]
  double min_length = 4.0;             ///< shorter lengths say nothing [voxels]
  double max_frame_angle_rad = 0.785;  ///< between the frame rotations of two candidates that agree
  // Of both twice as many where both viewpoints are known.
  int max_proposed = 24;  ///< hypotheses screened by re-matching in a common frame
  int max_refined = 4;    ///< hypotheses refined and ranked
};

struct ConvergenceOptions {
  int max_iterations = 50;
  double rotation_tolerance_rad = 1e-4;  ///< stop when the rotation step ...
  double translation_tolerance = 1e-3;   ///< ... and the step of the keypoint centroid [voxels] are both below
};

struct RefinementOptions {
  bool enabled = true;  ///< point-to-plane refinement on the dense clouds after the loop
};

struct Options {
  Search search = Search::hypotheses;
  int degrees_of_freedom = 6;  ///< 6, or 4 for levelled scans (yaw and translation)
  double level = 0.5;          ///< an answer is registered from this confidence on, [0.5, 1]
  int threads = 0;             ///< 0: all processors; the result does not depend on it
  ScaleOptions scale;
  KeypointOptions keypoints;
  DescriptorOptions descriptor;
  EnergyOptions energy;
  HypothesisOptions hypotheses;
  ConvergenceOptions convergence;
  RefinementOptions refinement;
};

/// The options of a preset: "default" or "paper" (the paper's Table 1 and nothing beyond its Algorithm 1).
/// Throws InvalidArgument for another name.
Options preset(std::string_view name);

/// Throws InvalidArgument that names the first option out of its range, its value and the range.
void validate(const Options& options);

}  // namespace igsp
