#include "core/stage_clock.hpp"

#include <gtest/gtest.h>

namespace igsp {
namespace {

using Reports = std::vector<std::pair<std::string, double>>;

TEST(StageClock, ReportsAndTimesTheStagesInOrder) {
  Reports reports;
  const ProgressCallback progress = [&](const Progress& p) {
    reports.emplace_back(std::string(p.stage), p.fraction);
    return true;
  };
  StageClock clock(progress);
  clock.start("one");
  clock.report(0.5);
  clock.start("two");
  clock.finish();
  clock.finish();  // nothing is running any more
  EXPECT_EQ(reports, (Reports{{"one", 0.0}, {"one", 0.5}, {"one", 1.0}, {"two", 0.0}, {"two", 1.0}}));
  ASSERT_EQ(clock.timings().size(), 2u);
  EXPECT_EQ(clock.timings()[0].first, "one");
  EXPECT_EQ(clock.timings()[1].first, "two");
  for (const auto& [stage, seconds] : clock.timings()) EXPECT_GE(seconds, 0.0) << stage;
}

TEST(StageClock, ThrowsWhereverTheCallerAsksToStop) {
  for (int stop_at = 0; stop_at < 3; ++stop_at) {
    int calls = 0;
    const ProgressCallback progress = [&](const Progress&) { return calls++ != stop_at; };
    StageClock clock(progress);
    const auto run = [&] {
      clock.start("stage");
      clock.report(0.5);
      clock.finish();
    };
    EXPECT_THROW(run(), Cancelled);
    EXPECT_EQ(calls, stop_at + 1) << "asked again after the answer to stop";
  }
}

TEST(StageClock, AnEmptyCallbackIsNeverCalled) {
  const ProgressCallback none;
  StageClock clock(none);
  clock.start("stage");
  clock.report(0.5);
  clock.finish();
  EXPECT_EQ(clock.timings().size(), 1u);
}

}  // namespace
}  // namespace igsp
