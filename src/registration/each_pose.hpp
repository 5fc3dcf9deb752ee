#pragma once

#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "registration/common_frame.hpp"

namespace igsp {

/// result[i] = ask(poses[i]) on the threads of the frame, which has their rotations described.
template <typename Result, typename Ask>
std::vector<Result> for_each_pose(const CommonFrame& frame, std::span<const Transformation> poses, const Ask& ask) {
  std::vector<Result> results(poses.size());
  parallel_blocks(poses.size(), frame.threads(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) results[i] = ask(poses[i]);
  });
  return results;
}

}  // namespace igsp
