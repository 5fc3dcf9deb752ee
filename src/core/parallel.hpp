#pragma once

#ifdef __SANITIZE_THREAD__
#include <exception>
#include <mutex>
#include <vector>
#else
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <thread>

namespace igsp {

/// How many threads work for an option of so many (0: as many as processors that the process may use).
inline std::size_t concurrency(int threads) {
#ifdef __SANITIZE_THREAD__
  static const std::size_t processors = std::max(1u, std::thread::hardware_concurrency());  // asks the file system
#else
  static const std::size_t processors = static_cast<std::size_t>(tbb::info::default_concurrency());
#endif
  return threads == 0 ? processors : std::min<std::size_t>(threads, processors);
}

#ifndef __SANITIZE_THREAD__
/// For so many threads, of the calling one alone. Kept, for its workers look for more work a while before they sleep,
/// and to be woken takes them longer than many a loop here. Never more threads than processors: TBB would warn.
inline tbb::task_arena& arena_of(int threads) {
  thread_local std::map<int, tbb::task_arena> arenas;
  return arenas.try_emplace(threads, threads).first->second;
}
#endif

/// Calls body(begin, end) on blocks of [0, size). Every index must write only its own output, so that the result does
/// not depend on the number of threads (0: all processors). One thread runs in the caller without a task arena.
template <typename Body>
void parallel_blocks(std::size_t size, int threads, std::size_t grain, const Body& body) {
  if (threads == 1 || size <= grain) {
    if (size > 0) body(std::size_t{0}, size);
    return;
  }
#ifdef __SANITIZE_THREAD__
  // Debian's TBB is not instrumented: the sanitizer would not see its forks and joins and report every one of them.
  // Plain threads show it the same bodies.
  const std::size_t count = std::min<std::size_t>(size, threads == 0 ? concurrency(0) : threads);  // none is empty
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&](std::size_t begin, std::size_t end) {
    try {
      body(begin, end);
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> team;
    for (std::size_t i = 0; i < count; ++i) team.emplace_back(work, size * i / count, size * (i + 1) / count);
  }
  if (failure) std::rethrow_exception(failure);
#else
  arena_of(static_cast<int>(concurrency(threads))).execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size, grain),
                      [&](const tbb::blocked_range<std::size_t>& block) { body(block.begin(), block.end()); });
  });
#endif
}

/// A task for another thread, unless it is taken back before that begins. It is one of the threads that loops have,
/// which stands on a processor of its own already; a new one may wait some milliseconds for that of its maker.
class TaskForAnother {
 public:
  template <typename Task>
  TaskForAnother([[maybe_unused]] int threads, const Task& task) {
    const auto unless_taken = [task, is_taken = is_taken_] {
      if (!is_taken->exchange(true)) task();
    };
#ifdef __SANITIZE_THREAD__
    thread_ = std::jthread(unless_taken);
#else
    arena_of(static_cast<int>(concurrency(threads))).enqueue(unless_taken);
#endif
  }
  /// Whether no thread has begun with it; none will then.
  bool take_back() {
    return !is_taken_->exchange(true);
  }

 private:
  std::shared_ptr<std::atomic<bool>> is_taken_ = std::make_shared<std::atomic<bool>>(false);
#ifdef __SANITIZE_THREAD__
  std::jthread thread_;
#endif
};

/// Both, at the same time where there are threads for it.
template <typename First, typename Second>
void parallel_pair(int threads, const First& first, const Second& second) {
  parallel_blocks(2, threads, 1, [&](std::size_t begin, std::size_t end) {
    if (begin == 0) first();
    if (end == 2) second();
  });
}

/// The same as parallel_blocks in slices, with tick(share done) between them on the calling thread, so that a caller
/// may report progress or throw to stop.
template <typename Body, typename Tick>
void parallel_slices(std::size_t size, int threads, std::size_t grain, std::size_t slice, const Body& body,
                     const Tick& tick) {
  for (std::size_t first = 0; first < size; first += slice) {
    tick(static_cast<double>(first) / static_cast<double>(size));
    parallel_blocks(std::min(slice, size - first), threads, grain,
                    [&](std::size_t begin, std::size_t end) { body(first + begin, first + end); });
  }
}

}  // namespace igsp
