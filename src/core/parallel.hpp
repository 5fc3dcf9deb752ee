#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace igsp {

/// Calls body(begin, end) on blocks of [0, size). Every index must write only its own output, so that the result does
/// not depend on the number of threads (0: all processors). One thread runs in the caller without a task arena.
template <typename Body>
void parallel_blocks(std::size_t size, int threads, std::size_t grain, const Body& body) {
  if (threads == 1 || size <= grain) {
    if (size > 0) body(std::size_t{0}, size);
    return;
  }
  tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size, grain),
                      [&](const tbb::blocked_range<std::size_t>& block) { body(block.begin(), block.end()); });
  });
}

}  // namespace igsp
