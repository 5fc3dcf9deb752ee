#include "core/concurrently.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace igsp {
namespace {

using namespace std::chrono_literals;

void do_nothing(const ProgressCallback&) {}

TEST(Concurrently, RunsBothForEveryNumberOfThreads) {
  for (const int threads : {0, 1, 2, 3}) {
    int first = 0, second = 0;
    concurrently(
        threads, {}, [&](const ProgressCallback&) { ++first; }, [&](const ProgressCallback&) { ++second; });
    EXPECT_EQ(first, 1);
    EXPECT_EQ(second, 1);
  }
}

TEST(Concurrently, TellsWhatEitherThrows) {
  const auto fail = [](const ProgressCallback&) { throw std::runtime_error("disk"); };
  for (const int threads : {1, 2}) {
    EXPECT_THROW(concurrently(threads, {}, fail, do_nothing), std::runtime_error);
    EXPECT_THROW(concurrently(threads, {}, do_nothing, fail), std::runtime_error);
    EXPECT_THROW(concurrently(threads, {}, fail, fail), std::runtime_error);
  }
}

TEST(Concurrently, OnlyTheCallingThreadReports) {
  const auto caller = std::this_thread::get_id();
  std::vector<std::pair<std::string, double>> reports;
  const ProgressCallback listen = [&](const Progress& progress) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    reports.emplace_back(progress.stage, progress.fraction);
    return true;
  };
  const auto long_stage = [&](const ProgressCallback& progress) {
    for (int i = 0; i <= 10; ++i) {
      if (!progress({"long", 0.1 * i})) return;
      std::this_thread::sleep_for(30ms);
    }
  };
  const auto short_stage = [](const ProgressCallback& progress) { progress({"short", 1.0}); };
  concurrently(2, listen, short_stage, long_stage);
  ASSERT_GE(reports.size(), 4u);
  EXPECT_EQ(reports[0], std::make_pair(std::string("short"), 1.0));
  EXPECT_EQ(reports[1], std::make_pair(std::string("long"), 0.0)) << "a stage begins where it is first heard of";
  EXPECT_EQ(reports.back(), std::make_pair(std::string("long"), 1.0));
}

/// Runs until its callback answers false, as the library's stages do.
struct Endless {
  std::atomic<bool>&has_begun, &has_ended;
  void operator()(const ProgressCallback& progress) const {
    has_begun = true;
    while (progress({"endless", 0.5})) std::this_thread::sleep_for(1ms);
    has_ended = true;
    throw Cancelled();
  }
};

void wait_for(const std::atomic<bool>& flag) {
  for (int i = 0; i < 1000 && !flag; ++i) std::this_thread::sleep_for(1ms);
}

TEST(Concurrently, StopsTheOtherThreadAsWell) {
  std::atomic<bool> has_begun = false, has_ended = false;
  int calls = 0;
  const ProgressCallback stop = [&](const Progress&) { return ++calls < 3; };
  EXPECT_THROW(concurrently(2, stop, do_nothing, Endless{has_begun, has_ended}), Cancelled);
  EXPECT_TRUE(has_ended);
  has_begun = has_ended = false;
  const auto fail = [&](const ProgressCallback&) {
    wait_for(has_begun);
    throw std::runtime_error("disk");
  };
  EXPECT_THROW(concurrently(2, {}, fail, Endless{has_begun, has_ended}), std::runtime_error);
  EXPECT_EQ(has_ended, has_begun) << "what the first one fails of stops the second";
}

TEST(Concurrently, DoesNotWaitForAThreadThatIsBusy) {
  std::atomic<bool> is_busy = false, may_end = false;
  {
    TaskForAnother busy(2, [&] {
      is_busy = true;
      wait_for(may_end);
      is_busy = false;
    });
    wait_for(is_busy);
    int runs = 0;
    concurrently(2, {}, do_nothing, [&](const ProgressCallback&) { ++runs; });
    EXPECT_EQ(runs, 1);
    const auto fail = [](const ProgressCallback&) { throw std::runtime_error("disk"); };
    EXPECT_THROW(concurrently(2, {}, fail, do_nothing), std::runtime_error);
    EXPECT_THROW(concurrently(2, {}, do_nothing, fail), std::runtime_error);
    may_end = true;
    busy.take_back();
  }
  while (is_busy) std::this_thread::sleep_for(1ms);
}

}  // namespace
}  // namespace igsp
