#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "igsp/options.hpp"
#include "igsp/point_cloud.hpp"

namespace igsp {

/// Two matched keypoints: indices into Result::source_keypoints and Result::target_keypoints.
struct KeypointMatch {
  std::uint32_t source;
  std::uint32_t target;
};

/// One pass of the loop (the paper's Algorithm 1).
struct IterationRecord {
  int k = 0;
  double w_fd = 1.0;  ///< Eq. 7
  double w_ed = 0.0;
  double t_cd = 0.0;                ///< mismatch threshold, Eq. 11 [bits]
  std::size_t candidate_edges = 0;  ///< pairs with CD < T_cd
  std::size_t matches = 0;          ///< |M|
  double energy = 0.0;              ///< Eq. 1 [bits]
  double rotation_step_rad = 0.0;
  double translation_step = 0.0;  ///< displacement of the centroid of one cloud's keypoints [units of the cloud]
  double seconds = 0.0;
  Transformation target_from_source = Transformation::Identity();  ///< after this iteration
  std::vector<KeypointMatch> correspondences;                      ///< M, `matches` of them
};

/// Why the loop ended.
enum class Termination {
  converged,
  max_iterations,
  too_few_keypoints,
  too_few_matches,     ///< fewer than 3 correspondences
  degenerate_matches,  ///< the correspondences lie on a line
};
std::string_view to_string(Termination termination);

struct CloudSummary {
  std::size_t points = 0;  ///< as given
  std::size_t voxels = 0;  ///< after the voxel filter
  std::size_t keypoints = 0;
  StrayPoints stray;                         ///< of the points as given, those that were left out
  std::optional<Eigen::Vector3d> viewpoint;  ///< where the scanner stood, as given
  Points part_viewpoints;                    ///< of a cloud of several scans, those that are known, as given
};

/// A rigid motion of the source that hardly changes how it lies on the target: the surfaces do not fix it.
struct FreeDirection {
  Eigen::Matrix<double, 6, 1> motion;  ///< (rotation, translation) about Precision::centre, target frame, unit length
                                       ///< with rotations scaled by the size of the scene
  std::string description;             ///< such as "translation along (1.00, 0.00, 0.00)"
};

/// How well the surfaces fix the transformation, from the residuals of the fine registration; those of one patch of
/// surface count as one (docs/covariance.md).
/// Order: rotation about x, y, z [rad], translation along x, y, z [units of the cloud]; the small motion is applied on
/// the left, in the target's frame, rotations about `centre`. With 4 degrees of freedom the four have a covariance of
/// their own, not correlated with the tilt.
struct Precision {
  double inlier_rmse = 0;  ///< robust RMS of the distances along the normals where the surfaces lie on each other
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< inverse; 0 where not determined
  double scale = 1.0;        ///< by which the source would have to be multiplied to fit best; see scale_sigma
  double scale_sigma = 0.0;  ///< its standard deviation, from the residuals; 0: the surfaces do not tell the scale
  std::vector<FreeDirection> free_directions;  ///< at the pose; where it is refused and has none, of the target alone
};

/// How one cloud contradicts what the scanner of the other saw: it saw through this space, so it is empty.
struct FreeSpaceViolation {
  std::size_t in_view = 0;        ///< of the voxels that were looked at, those where the scanner saw something
  std::size_t contradicting = 0;  ///< of them, those in front of what it saw
  double share() const;           ///< contradicting of in_view, [0, 1); where few are in view, less
};

/// Both directions, of those that can be told.
struct FreeSpace {
  std::optional<FreeSpaceViolation> source;  ///< source before the target's scanner, if that one's viewpoint is known
  std::optional<FreeSpaceViolation> target;  ///< target before the source's scanner
  double violation() const;                  ///< the larger share; 0 where no viewpoint is known
};

/// What the verdict is made of: independent questions to the clouds at the pose.
struct Evidence {
  std::size_t mutual_matches = 0;    ///< mutual nearest neighbours among the descriptors in a common frame ...
  std::size_t agreeing_matches = 0;  ///< ... and those of them within 2.5 voxels
  double contact_share = 0.0;        ///< of the places where the surfaces meet, the share where they touch, (0, 1)
  double quality = 0.0;              ///< Q of docs/method.md: what both say as log10 odds that the pose is right
  double rival_odds = 0.0;           ///< odds of the other poses that were looked into, against this one
  FreeSpace free_space;
  double voxel_size =
      0.0;  ///< at which the questions were asked [units of the cloud]: Result::voxel_size times 1, 2, 4 or 8
};

/// The best other pose that was looked into.
struct RunnerUp {
  Transformation target_from_source = Transformation::Identity();
  double share =
      0.0;  ///< its agreeing matches in terms of the winner's, [0, 1]: near 1, the two are hard to tell apart
};

/// What `align` answers. Not being able to register is an answer, never an exception.
struct Result {
  bool registered = false;  ///< the verdict
  double confidence = 0.0;  ///< that target_from_source is right, [0, 1]
  std::string reason;       ///< one sentence with the evidence for the verdict
  Termination termination = Termination::converged;
  Transformation target_from_source = Transformation::Identity();  ///< best estimate; meaningless unless `has_estimate`
  bool has_estimate = false;                                       ///< false: there is no transformation to look at
  double overlap_source = 0.0;  ///< share of the source's voxels with the target's surface at the pose, [0, 1]
  double overlap_target = 0.0;  ///< the same for the target
  Evidence evidence;
  std::optional<RunnerUp> runner_up;
  Precision precision;
  double rmse = 0.0;        ///< inlier RMSE: distances along the normals where the surfaces meet [units of the cloud]
  double voxel_size = 0.0;  ///< [units of the cloud]
  /// At which `source_keypoints`, `target_keypoints` and `iterations` were made [units of the cloud]: voxel_size times
  /// 1, 2, 4 or 8.
  double loop_voxel_size = 0.0;
  CloudSummary source;
  CloudSummary target;
  Points source_keypoints;  ///< as given, not moved; at the scale where the loop ran: `iterations` refer to them
  Points target_keypoints;
  std::vector<IterationRecord> iterations;
  std::vector<std::pair<std::string, double>> timings_s;  ///< per stage, wall seconds, in order
  Options options;                                        ///< as used

  double overlap() const { return overlap_source < overlap_target ? overlap_source : overlap_target; }
};

}  // namespace igsp
