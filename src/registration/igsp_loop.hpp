#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "igsp/features.hpp"
#include "igsp/result.hpp"

namespace igsp {

/// What the loop works on, in one local frame of reference for each cloud.
struct LoopInput {
  PointView source_keypoints;
  PointView target_keypoints;
  std::span<const Descriptor> source_variants;  ///< m x variants, row-major
  int variants = 4;
  std::span<const Descriptor> target_descriptors;
  double voxel_size = 0;
};

/// How the loop runs. The defaults are the paper's; the hypotheses search enters it later and knows what to expect of
/// true matches, because its descriptors stand in a common frame.
struct LoopSchedule {
  int first_k = 0;
  int max_iterations = 50;
  double fit_scale = 0;  ///< Geman-McClure scale of the rigid fit [voxels]; 0: plain least squares (Eq. 9)
  struct Bounds {
    double fd, ed;
  };
  std::optional<Bounds> bounds;  ///< T_cd = W_fd fd + W_ed ed in place of Eq. 11 [bits]
};

struct LoopOutcome {
  Termination termination = Termination::max_iterations;
  bool has_estimate = false;
  Transformation target_from_source = Transformation::Identity();
  std::vector<IterationRecord> iterations;
};

/// Algorithm 1: globally optimal correspondences in the hybrid metric and the transformation they give, in turn, from
/// coarse to fine. `tick` is called at the start of every iteration with its number from 0 on, and may throw.
LoopOutcome igsp_loop(const LoopInput& input, const Transformation& initial, const LoopSchedule& schedule,
                      const Options& options, const std::function<void(int)>& tick = {});

}  // namespace igsp
