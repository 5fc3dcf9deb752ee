// What a run on two clouds of 100,000 points tells its caller, and that it stops wherever it is told to.
#include <gtest/gtest.h>

#include <algorithm>

#include "scenes.hpp"

namespace igsp {
namespace {

using testing::Pair;
using Stages = std::vector<std::string>;

constexpr int points = 100000;

struct Report {
  std::string stage;
  double fraction;
};

std::vector<Report> reports_of(const Pair& pair, const Transformation* initial = nullptr, const Options& options = {}) {
  std::vector<Report> reports;
  const ProgressCallback listen = [&](const Progress& progress) {
    reports.push_back({std::string(progress.stage), progress.fraction});
    return true;
  };
  initial ? align(pair.source, pair.target, *initial, options, listen)
          : align(pair.source, pair.target, options, listen);
  return reports;
}

Stages stages_of(const std::vector<Report>& reports) {
  Stages stages;
  for (const Report& report : reports)
    if (report.fraction == 0.0 && (stages.empty() || stages.back() != report.stage)) stages.push_back(report.stage);
  return stages;
}

const Stages features_of_both = {"scale", "voxel grid", "common frame"};

Stages after_features(const std::vector<Stages>& parts) {
  Stages stages = features_of_both;
  for (const Stages& part : parts) stages.insert(stages.end(), part.begin(), part.end());
  return stages;
}

TEST(ProgressOfAlign, NamesEveryStage) {
  const Pair pair = testing::simulated_pair("park", points);
  const Pair hopeless{pair.source, testing::simulated_pair("park", points, 0, 8).target, pair.truth};
  const Stages coarser = {"coarser scale", "hypotheses", "screening", "ranking"};
  const Stages finest = {"keypoints", "descriptors", "keypoints", "descriptors", "hypotheses", "screening", "ranking"};
  const Stages end = {"loop", "refinement", "verdict"};
  EXPECT_EQ(stages_of(reports_of(pair)), after_features({coarser, coarser, end}));
  EXPECT_EQ(stages_of(reports_of(hopeless)), after_features({coarser, coarser, coarser, finest, end}))
      << "no scale settles this pair";
  EXPECT_EQ(stages_of(reports_of(pair, &pair.truth)),
            after_features({{"keypoints", "descriptors", "keypoints", "descriptors"}, end}));
}

TEST(ProgressOfAlign, EveryStageRunsFromZeroToOne) {
  const std::vector<Report> reports = reports_of(testing::simulated_pair("indoor", points));
  EXPECT_EQ(reports.front().fraction, 0.0);
  EXPECT_EQ(reports.back().fraction, 1.0);
  for (std::size_t i = 1; i < reports.size(); ++i) {
    const Report &before = reports[i - 1], &now = reports[i];
    SCOPED_TRACE(now.stage);
    const bool begins = before.fraction == 1.0 && now.fraction == 0.0;
    if (!begins) {
      EXPECT_EQ(now.stage, before.stage);
      EXPECT_GE(now.fraction, before.fraction);
    }
    EXPECT_GE(now.fraction, 0.0);
    EXPECT_LE(now.fraction, 1.0);
  }
}

/// No stage is silent for long: the parts that grow with the clouds report in slices.
TEST(ProgressOfAlign, ReportsOften) {
  for (const char* scene : {"park", "indoor", "object"}) {
    SCOPED_TRACE(scene);
    const std::vector<Report> reports = reports_of(testing::simulated_pair(scene, points));
    EXPECT_GE(reports.size(), 50u);
    for (const char* stage : {"coarser scale", "screening", "loop"}) {
      const auto inside = [&](const Report& r) { return r.stage == stage && r.fraction > 0.0 && r.fraction < 1.0; };
      EXPECT_GE(std::count_if(reports.begin(), reports.end(), inside), 1) << stage;
    }
  }
}

TEST(ProgressOfAlign, StopsInEveryStage) {
  const Pair pair = testing::simulated_pair("object", points);
  Options options;
  options.threads = 1;  // what is heard of another thread depends on when
  const std::vector<Report> reports = reports_of(pair, nullptr, options);
  Stages stopped_in;
  for (std::size_t last = 1; last <= reports.size(); ++last) {
    const Report& report = reports[last - 1];
    const bool is_new = std::find(stopped_in.begin(), stopped_in.end(), report.stage) == stopped_in.end();
    if (!is_new) continue;
    stopped_in.push_back(report.stage);
    std::size_t calls = 0;
    EXPECT_THROW(align(pair.source, pair.target, options, [&](const Progress&) { return ++calls < last; }), Cancelled);
    EXPECT_EQ(calls, last) << "work went on in " << report.stage << " after the callback said stop";
  }
  EXPECT_EQ(stopped_in.size(), 10u);
}

}  // namespace
}  // namespace igsp
