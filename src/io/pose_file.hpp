#pragma once

#include <filesystem>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp::io {

/// A pose and when it was taken, or its place in a file that does not say when.
struct TimedPose {
  double time = 0;
  Transformation pose = Transformation::Identity();
};

/// One transformation as text (see read_transformation), or a trajectory: TUM has lines `time x y z qx qy qz qw`, KITTI
/// the 12 numbers of the upper three rows on every line. The content decides. Throws FileError with path and line.
std::vector<TimedPose> read_poses(const std::filesystem::path& path);

/// In the form that the extension stands for: .tum, .kitti, or one transformation as 4x4 text. Whole or not at all.
/// Throws FileError, and InvalidArgument for several poses under another name.
void write_poses(const std::filesystem::path& path, const std::vector<TimedPose>& poses);

}  // namespace igsp::io
