#pragma once

#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "registration/common_frame.hpp"

namespace igsp {

/// result[i] = look(poses[i]) on the threads of the frame, the rotations being described before.
template <typename Result, typename Look>
std::vector<Result> look_into_each(CommonFrame& frame, std::span<const Transformation> poses, const Look& look) {
  frame.describe(poses);
  std::vector<Result> results(poses.size());
  parallel_blocks(poses.size(), frame.threads(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) results[i] = look(poses[i]);
  });
  return results;
}

}  // namespace igsp
