#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "benchmark/cases.hpp"
#include "benchmark/judgement.hpp"
#include "benchmark/results.hpp"
#include "benchmark/summary.hpp"
#include "igsp/errors.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* header =
    "name,group,source,target,truth,max_rotation_error_deg,max_translation_error_m,overlap\n";

class BenchmarkFiles : public testing::Test {
 protected:
  BenchmarkFiles() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("igsp_benchmark_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~BenchmarkFiles() override { fs::remove_all(folder_); }

  fs::path file(const std::string& text) const {
    std::ofstream(folder_ / "cases.csv", std::ios::binary) << text;
    return folder_ / "cases.csv";
  }
  // The message of the error that reading the cases meets.
  std::string complaint(const std::string& text) const {
    try {
      read_cases(file(text));
    } catch (const FileError& error) {
      return error.what();
    }
    return "no error";
  }
  void complains(const std::string& text, const std::vector<std::string>& words) const {
    const std::string message = complaint(text);
    for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << " in " << message;
  }

  fs::path folder_;
};

TEST_F(BenchmarkFiles, CasesAreReadRelativeToTheFile) {
  const auto cases = read_cases(file(std::string("\xef\xbb\xbf") + header +
                                     "a/1,a,x.ply,\"y, \"\"new\"\".ply\",t.txt,5,0.005,0.9\r\n\r\n"
                                     "b/1,b,/abs/x.ply,y.ply,none,0,0,0\nb/2,b,x.ply,y.ply,-,,,"));
  ASSERT_EQ(cases.size(), 3u);
  EXPECT_EQ(cases[0].name, "a/1");
  EXPECT_EQ(cases[0].source, folder_ / "x.ply");
  EXPECT_EQ(cases[0].target, folder_ / "y, \"new\".ply");
  EXPECT_EQ(cases[0].truth_file, folder_ / "t.txt");
  EXPECT_EQ(cases[0].truth, Truth::known);
  EXPECT_EQ(cases[0].max_rotation_error_deg, 5.0);
  EXPECT_EQ(cases[0].max_displacement, 0.005);
  EXPECT_EQ(cases[1].source, "/abs/x.ply");
  EXPECT_EQ(cases[1].truth, Truth::none);
  EXPECT_EQ(cases[2].truth, Truth::unknown);
}

TEST_F(BenchmarkFiles, GroupMayBeLeftOutAndColumnsMayStandInAnyOrder) {
  const auto cases =
      read_cases(file("truth,target,source,note,name,max_translation_error_m,max_rotation_error_deg\n"
                      "t.txt,y.ply,x.ply,hello,n,0.3,2\n"));
  EXPECT_EQ(cases[0].group, "all");
  EXPECT_EQ(cases[0].name, "n");
  EXPECT_EQ(cases[0].max_displacement, 0.3);
}

TEST_F(BenchmarkFiles, ViewpointsInTheFilesFrames) {
  using Kind = ViewpointRequest::Kind;
  const std::string columns =
      "name,source,target,truth,max_rotation_error_deg,max_translation_error_m,source_viewpoint,target_viewpoint\n";
  const auto cases =
      read_cases(file(columns + "a,x.ply,y.ply,none,0,0,0 -1.5 2e3,\"0,0,10\"\nb,x.ply,y.ply,none,0,0,,auto\n"));
  EXPECT_EQ(cases[0].source_viewpoint.kind, Kind::given);
  EXPECT_EQ(cases[0].source_viewpoint.position, Eigen::Vector3d(0, -1.5, 2000));
  EXPECT_EQ(cases[0].target_viewpoint.position, Eigen::Vector3d(0, 0, 10));
  EXPECT_EQ(cases[1].source_viewpoint.kind, Kind::none);
  EXPECT_EQ(cases[1].target_viewpoint.kind, Kind::automatic);
  complains(columns + "a,x.ply,y.ply,none,0,0,0 0,\n", {"line 2", "column 7 (source_viewpoint)", "'0 0'", "x y z"});
  EXPECT_EQ(read_cases(file(std::string(header) + "a,g,x.ply,y.ply,none,0,0,1\n"))[0].source_viewpoint.kind,
            Kind::none);
}

TEST_F(BenchmarkFiles, BrokenListsAreNamedByLineAndColumn) {
  const std::string good = "a,g,x.ply,y.ply,t.txt,5,0.005,1\n";
  complains("", {"cases.csv", "empty"});
  complains("\n", {"cases.csv", "line 1", "no header"});
  complains(header, {"line 2", "no case"});
  complains("name,source,target\n", {"line 1", "truth is missing"});
  complains(header + good + "b,g,x.ply,y.ply,t.txt,five,0.005,1\n",
            {"line 3", "column 6 (max_rotation_error_deg)", "five"});
  complains(header + good + "b,g,x.ply,y.ply,t.txt,5,-1,1\n", {"line 3", "column 7 (max_translation_error_m)", "-1"});
  complains(header + good + "b,g,x.ply,y.ply,t.txt,5,nan,1\n", {"line 3", "column 7"});
  complains(header + good + "b,g,,y.ply,t.txt,5,1,1\n", {"line 3", "column 3 (source)", "empty"});
  complains(header + good + "b,g,x.ply\n", {"line 3", "column 4", "3 columns", "8"});
  complains(header + good + good, {"line 3", "column 1 (name)", "'a' is there already"});
  complains(header + good + "b,\"g,x.ply\n", {"line 3", "column 2", "not closed"});
  EXPECT_THROW(read_cases(folder_ / "nowhere.csv"), FileError);
  EXPECT_THROW(read_cases(folder_), FileError);
}

TEST(BenchmarkCases, OnlyGroupsAndPatterns) {
  std::vector<BenchmarkCase> cases(4);
  for (std::size_t i = 0; i < 4; ++i) cases[i].name = std::vector{"a/1", "a/12", "b/1", "c/1"}[i];
  for (std::size_t i = 0; i < 4; ++i) cases[i].group = std::vector{"a", "a", "b", "c"}[i];
  EXPECT_EQ(select_cases(cases, {}).size(), 4u);
  EXPECT_EQ(select_cases(cases, {"a"}).size(), 2u);
  EXPECT_EQ(select_cases(cases, {"*/1"}).size(), 3u);
  EXPECT_EQ(select_cases(cases, {"?/12"})[0].name, "a/12");
  EXPECT_EQ(select_cases(cases, {"b", "a/12"})[0].name, "a/12");  // in the order of the list
  EXPECT_THROW(select_cases(cases, {"a", "d"}), InvalidArgument);
}

const Eigen::Vector3d centre(1, 2, 3);

TEST(Scramble, IsARigidMotionByThreeDiagonals) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Transformation motion = scramble(seed, "name", centre, 2.0);
    EXPECT_NEAR((motion.linear() * motion.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-14);
    EXPECT_NEAR(motion.linear().determinant(), 1.0, 1e-14);
    EXPECT_NEAR((motion * centre - centre).norm(), 6.0, 1e-12);
  }
}

TEST(Scramble, DependsOnSeedAndNameAlone) {
  const auto matrix = [](std::uint64_t seed, const char* name) { return scramble(seed, name, centre, 2.0).matrix(); };
  EXPECT_EQ(matrix(7, "a"), matrix(7, "a"));
  EXPECT_GT((matrix(7, "a") - matrix(8, "a")).norm(), 0.1);
  EXPECT_GT((matrix(7, "a") - matrix(7, "b")).norm(), 0.1);
}

Transformation rotation_z(double angle, const Eigen::Vector3d& translation) {
  Transformation motion = Transformation::Identity();
  motion.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  motion.translation() = translation;
  return motion;
}

BenchmarkCase known_case() {
  BenchmarkCase one;
  one.truth = Truth::known;
  one.max_rotation_error_deg = 5.0;
  one.max_displacement = 0.5;
  return one;
}

// The answer that a scrambled source gets: `error` on top of the truth.
Result answer(const Transformation& error, const Transformation& truth, const Transformation& motion) {
  Result result;
  result.registered = result.has_estimate = true;
  result.target_from_source = error * truth * motion.inverse();
  return result;
}

TEST(JudgeCase, APerfectAnswerToAScrambledSourceHasNoError) {
  const Transformation truth = rotation_z(0.7, {5, 6, 7}), motion = scramble(7, "a", centre, 10.0);
  const Judgement judgement =
      judge_case(known_case(), truth, centre, motion, answer(Transformation::Identity(), truth, motion));
  EXPECT_EQ(judgement.success, true);
  EXPECT_LT(judgement.error->rotation_rad, 1e-15);
  EXPECT_LT(judgement.error->translation, 1e-13);
  EXPECT_LT(judgement.error->centroid_displacement, 1e-13);
}

TEST(JudgeCase, ErrorsByHandFromTinyToHalfATurn) {
  const Transformation truth = rotation_z(0.0, {0, 0, 0}), motion = scramble(7, "a", centre, 1.0);
  for (const double angle : {1e-9, 1e-4, 0.01, 1.0, std::numbers::pi}) {
    const Transformation error = rotation_z(angle, {0, 0, 0});
    const Judgement judgement =
        judge_case(known_case(), truth, {1, 0, 0}, Transformation::Identity(), answer(error, truth, truth));
    EXPECT_NEAR(judgement.error->rotation_rad / angle, 1.0, 1e-12);
    EXPECT_NEAR(judgement.error->centroid_displacement / (2 * std::sin(angle / 2)), 1.0, 1e-9);
    EXPECT_EQ(judgement.error->translation, 0.0);
    EXPECT_NEAR(judge_case(known_case(), truth, centre, motion, answer(error, truth, motion)).error->rotation_rad,
                angle, 1e-14);
  }
}

TEST(JudgeCase, BothThresholdsCountAndTheVerdictDoesNot) {
  const Transformation truth = rotation_z(0.2, {1, 1, 1}), still = Transformation::Identity();
  const auto success = [&](double degrees, double shift, bool registered) {
    Result result = answer(rotation_z(degrees * std::numbers::pi / 180.0, {0, 0, shift}), truth, still);
    result.registered = registered;
    return judge_case(known_case(), truth, truth.inverse() * Eigen::Vector3d::Zero(), still, result).success;
  };
  EXPECT_EQ(success(4.99, 0.49, true), true);
  EXPECT_EQ(success(4.99, 0.49, false), true);
  EXPECT_EQ(success(5.01, 0.0, true), false);
  EXPECT_EQ(success(0.0, 0.51, true), false);
}

TEST(JudgeCase, NoTruthNoOverlapNoEstimate) {
  const Transformation still = Transformation::Identity();
  Result result = answer(still, still, still);
  BenchmarkCase one = known_case();
  one.truth = Truth::unknown;
  EXPECT_EQ(judge_case(one, still, centre, still, result).success, std::nullopt);
  one.truth = Truth::none;
  EXPECT_EQ(judge_case(one, still, centre, still, result).success, false);
  EXPECT_FALSE(judge_case(one, still, centre, still, result).error);
  result.registered = false;
  EXPECT_EQ(judge_case(one, still, centre, still, result).success, true);
  one.truth = Truth::known;
  result.has_estimate = false;
  EXPECT_EQ(judge_case(one, still, centre, still, result).success, false);
  EXPECT_FALSE(judge_case(one, still, centre, still, result).error);
}

TEST(JudgeMatches, TheLastIterationAtTheTruth) {
  const Transformation truth = rotation_z(0.7, {5, 6, 7});
  Result result;
  result.voxel_size = 2.0;  // with r_k of 3 voxels the radius is 2
  result.options.keypoints.suppression_radius = 3.0;
  EXPECT_FALSE(judge_matches(result, truth));
  result.source_keypoints = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
  for (const Eigen::Vector3d& keypoint : result.source_keypoints) result.target_keypoints.push_back(truth * keypoint);
  result.target_keypoints[1].z() += 1.9;  // still the same place
  result.target_keypoints[3].z() += 2.1;  // no more
  result.iterations.resize(2);
  result.iterations[0].correspondences = {{0, 0}, {1, 1}, {2, 2}};
  result.iterations[1].correspondences = {{0, 0}, {1, 2}, {3, 3}, {2, 2}};
  const auto quality = judge_matches(result, truth);
  ASSERT_TRUE(quality);
  EXPECT_EQ(quality->precision(), 2.0 / 4.0);
  EXPECT_EQ(quality->recall(), 2.0 / 3.0);
  EXPECT_EQ(judge_matches(result, rotation_z(0.0, {99, 0, 0}))->precision(), 0.0);
}

BenchmarkRow row(const char* name, const char* truth, const char* verdict, std::optional<bool> success, double e_r) {
  BenchmarkRow one;
  one.name = name;
  one.group = "g";
  one.preset = "default";
  one.scramble = "7";
  one.truth = truth;
  one.verdict = verdict;
  one.success = success;
  if (one.truth == "known") {
    one.e_r_deg = e_r;
    one.centroid_displacement = e_r / 10;
  }
  one.cpu_seconds = 2.0;
  return one;
}

TEST_F(BenchmarkFiles, ResultsReadBackAsWritten) {
  BenchmarkRow written = row("a, \"b\"", "known", "registered", true, 1.0 / 3.0);
  written.reason = "two\nlines";
  const auto rows = read_results(file(results_header() + results_line(written) + results_line(BenchmarkRow{})));
  ASSERT_EQ(rows.size(), 1u);  // an empty row is a blank line
  EXPECT_EQ(rows[0].name, written.name);
  EXPECT_EQ(rows[0].e_r_deg, written.e_r_deg);
  EXPECT_EQ(rows[0].success, true);
  EXPECT_EQ(rows[0].overlap, std::nullopt);
  EXPECT_EQ(rows[0].reason, "two lines");
}

TEST_F(BenchmarkFiles, ResultsOfAnEarlierVersionLackColumnsAndThoseOfOthersHaveMore) {
  const auto rows = read_results(file("name,preset,verdict,success,version\na,default,registered,yes,1.0\n"));
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_TRUE(rows[0].right_and_said());
  EXPECT_EQ(rows[0].precision, std::nullopt);
  EXPECT_EQ(rows[0].cpu_seconds, std::nullopt);
}

TEST_F(BenchmarkFiles, ALineThatWasCutOffIsLeftOut) {
  const std::string line = results_line(row("a", "known", "registered", true, 1.0));
  const std::string cut = results_header() + line + line.substr(0, line.size() / 2);
  EXPECT_EQ(read_results(file(cut), LastLine::ended).size(), 1u);
  EXPECT_THROW(read_results(file(cut)), FileError);
  EXPECT_THROW(read_results(file(header)), FileError);  // a list of cases is no result
}

TEST(Summary, CountsByHand) {
  EXPECT_EQ(median({}), std::nullopt);
  EXPECT_EQ(median({3, 1, 2}), 2.0);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  const std::string text = summary_text(
      {row("right1", "known", "registered", true, 1.0), row("right2", "known", "registered", true, 3.0),
       row("shy", "known", "not_registered", true, 5.0), row("lost", "known", "not_registered", false, 90.0),
       row("wrong", "known", "registered", false, 170.0), row("odd", "none", "registered", false, 0.0),
       row("fine", "none", "not_registered", true, 0.0), row("open", "-", "registered", std::nullopt, 0.0)});
  EXPECT_TRUE(text.starts_with("false accepts: 2\n  wrong (default)")) << text;
  // false, cases, recall, right, refused, errors, medians of 1, 3, 5
  EXPECT_NE(text.find("g                   2      8      0.400 (2/5)      3        3       0"), std::string::npos)
      << text;
}

TEST(Comparison, BetterAndWorse) {
  const std::string text =
      comparison_text({row("a", "known", "not_registered", false, 1), row("b", "known", "registered", true, 2),
                       row("c", "none", "not_registered", true, 0), row("d", "known", "registered", true, 4),
                       row("gone", "known", "registered", true, 4), row("e", "-", "registered", std::nullopt, 0)},
                      {row("a", "known", "registered", true, 1), row("b", "known", "not_registered", true, 1),
                       row("c", "none", "registered", false, 0), row("d", "known", "registered", true, 2),
                       row("new", "known", "registered", true, 4), row("e", "-", "not_registered", std::nullopt, 0)});
  EXPECT_EQ(text,
            "compared: 5 of 6 rows are in both\n"
            "worse: 2\n"
            "  b (default): right -> right but refused\n"
            "  c (default): rightly refused -> FALSE ACCEPT\n"
            "better: 1\n"
            "  a (default): refused -> right\n"
            "another verdict, truth unknown: 1\n"
            "  e (default): registered -> not_registered\n"
            "e_r: median of new / old 0.500, 2 pairs\n"
            "centroid displacement: median of new / old 0.500, 2 pairs\n"
            "CPU seconds: median of new / old 1.000, 5 pairs\n");
}

}  // namespace
}  // namespace igsp::cli
