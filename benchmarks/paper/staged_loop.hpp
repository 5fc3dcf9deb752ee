#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "igsp/evaluation.hpp"
#include "igsp/features.hpp"
#include "pairs.hpp"
#include "registration/igsp_loop.hpp"

namespace igsp::paper {

/// CPU time of the process: with one thread, what the paper's seconds mean, whatever else the machine does.
inline double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// The paper's preset on one thread.
Options paper_options();

/// A pair of clouds prepared for the paper's loop (Algorithm 1, lines 1-3), which then runs as often as one likes.
class StagedLoop {
 public:
  StagedLoop(const Pair& pair, const Options& options);
  StagedLoop(Features source, Features target);

  /// From the identity in the local frames: for a pair moved at random as good as any other start.
  LoopOutcome run(const Options& options) const;

  Options options_at_scale(Options options) const;  ///< with this pair's voxel size
  double ed_scale(const Options& options) const;    ///< s_ed of Eq. 3 [bits per unit of the cloud]
  Transformation to_world(const Transformation& local) const;

  const Features& source() const { return source_; }
  const Features& target() const { return target_; }
  const Points& source_keypoints() const { return source_keypoints_; }  ///< local, as are the target's
  const Points& target_keypoints() const { return target_keypoints_; }
  const std::vector<Descriptor>& source_variants() const { return source_variants_; }
  double preparation_s() const { return preparation_s_; }  ///< T1: scale, voxels, keypoints, descriptors

 private:
  void prepare();

  Features source_, target_;
  Points source_keypoints_, target_keypoints_;
  std::vector<Descriptor> source_variants_;
  double preparation_s_ = 0;
};

/// Eq. 14 of one iteration; a true pair is closer than `share` of r_k at the true transformation.
MatchQuality quality_of(const IterationRecord& record, const StagedLoop& loop, const Options& options,
                        const Transformation& truth, double share = 1.0 / 3.0);

Eigen::Vector3d centroid_of(PointView points);

/// Within the pair's thresholds.
bool is_right(const PoseError& error, const Pair& pair);

}  // namespace igsp::paper
