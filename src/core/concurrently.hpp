#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>

#include "core/parallel.hpp"
#include "core/report_progress.hpp"
#include "igsp/errors.hpp"
#include "igsp/progress.hpp"

namespace igsp {

/// The progress of another thread, kept for the one that may call the caller's callback.
class RelayedProgress {
 public:
  ProgressCallback callback() {
    return [this](const Progress& progress) {
      const std::lock_guard lock(mutex_);
      stage_ = progress.stage;
      fraction_ = progress.fraction;
      return !is_stopped_;
    };
  }
  void stop() {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
  }
  void end() {
    const std::lock_guard lock(mutex_);
    is_ended_ = true;
    ended_.notify_one();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [this] { return is_ended_; });
  }
  /// Tells `progress` of the other thread until that ends. Throws Cancelled.
  void pass_on(const ProgressCallback& progress) {
    std::string told;  // the stage that `progress` knows of
    std::unique_lock lock(mutex_);
    while (!ended_.wait_for(lock, std::chrono::milliseconds(50), [this] { return is_ended_; })) {
      const std::string stage = stage_;
      const double fraction = fraction_;
      if (stage.empty()) continue;
      lock.unlock();
      if (told != stage) {
        if (!told.empty()) report_progress(progress, told, 1.0);
        report_progress(progress, stage, 0.0);
        told = stage;
      }
      report_progress(progress, stage, fraction);
      lock.lock();
    }
    lock.unlock();
    if (!told.empty()) report_progress(progress, told, 1.0);
  }

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  std::string stage_;
  double fraction_ = 0;
  bool is_stopped_ = false, is_ended_ = false;
};

/// first(progress) on the calling thread and second(progress) on another one at the same time; one after the other
/// where there is one thread (0: as many as processors), or none free. `progress` is called on the calling thread
/// alone; it hears of the second where the first has ended before. What either throws is thrown, of two the first's.
template <typename First, typename Second>
void concurrently(int threads, const ProgressCallback& progress, const First& first, const Second& second) {
  if (concurrency(threads) == 1) {
    first(progress);
    second(progress);
    return;
  }
  RelayedProgress relayed;
  std::exception_ptr failure;
  TaskForAnother other(threads, [&] {
    try {
      second(relayed.callback());
    } catch (...) {
      failure = std::current_exception();
    }
    relayed.end();
  });
  try {
    first(progress);
  } catch (...) {
    relayed.stop();
    if (!other.take_back()) relayed.wait();
    throw;
  }
  if (other.take_back()) return second(progress);
  try {
    relayed.pass_on(progress);
  } catch (...) {
    relayed.stop();
    relayed.wait();
    throw;
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace igsp
