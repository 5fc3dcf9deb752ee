#pragma once

#include <cstddef>
#include <vector>

#include "io/pose_file.hpp"

namespace igsp::cli {

struct ErrorRange {
  double mean = 0, max = 0;
};

/// A trajectory against the true one; independent of the frame in which either is given.
struct TrajectoryError {
  std::size_t poses = 0;                           ///< that both have
  ErrorRange step_rotation_rad, step_translation;  ///< relative pose error of consecutive poses
  ErrorRange position;                             ///< of positions after the best rigid motion of the estimate
  double position_rmse = 0;                        ///< absolute trajectory error
};

/// Poses are the same if their times agree to a thousandth. Throws InvalidArgument for less than two.
TrajectoryError trajectory_error(const std::vector<io::TimedPose>& estimate, const std::vector<io::TimedPose>& truth);

}  // namespace igsp::cli
