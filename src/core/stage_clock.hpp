#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "core/report_progress.hpp"
#include "igsp/progress.hpp"

namespace igsp {

using StageTimings = std::vector<std::pair<std::string, double>>;

/// Times the stages of a run, reports them to the caller's progress callback and carries its wish to stop: every
/// method throws Cancelled when the callback answers false.
class StageClock {
 public:
  explicit StageClock(const ProgressCallback& progress) : progress_(progress) {}

  void start(const char* stage) {
    stop();
    stage_ = stage;
    begin_ = Clock::now();
    report(0.0);
  }
  void report(double fraction) const { report_progress(progress_, stage_, fraction); }
  void finish() { stop(); }
  const StageTimings& timings() const { return timings_; }  ///< by stage, in the order of their first start

 private:
  using Clock = std::chrono::steady_clock;
  void stop() {
    if (stage_.empty()) return;
    report(1.0);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    const auto same = std::ranges::find(timings_, stage_, &StageTimings::value_type::first);
    if (same == timings_.end()) {
      timings_.emplace_back(stage_, seconds);
    } else {
      same->second += seconds;
    }
    stage_.clear();
  }

  const ProgressCallback& progress_;
  std::string stage_;
  Clock::time_point begin_;
  StageTimings timings_;
};

}  // namespace igsp
