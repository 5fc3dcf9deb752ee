// The Stanford Bunny's raw range scans, when they lie beside the source tree. They are not part of the project (their
// terms do not allow it), so without them these tests are skipped, and say so.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scenes.hpp"

namespace igsp {
namespace {

const std::filesystem::path folder = IGSP_REAL_SCANS;

struct Case {
  std::string name, group, source, target, truth;
  double max_rotation_error_deg = 0.0;
  double max_translation_error = 0.0;
  double overlap = 0.0;
};

std::vector<Case> read_cases() {
  std::vector<Case> cases;
  std::ifstream file(folder / "cases.csv");
  std::string line;
  std::getline(file, line);  // header
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    Case row;
    std::string rotation, translation, overlap;
    for (std::string* field :
         {&row.name, &row.group, &row.source, &row.target, &row.truth, &rotation, &translation, &overlap})
      std::getline(fields, *field, ',');
    if (row.group != "bunny" || std::stod(overlap) < 0.6) continue;
    row.max_rotation_error_deg = std::stod(rotation);
    row.max_translation_error = std::stod(translation);
    row.overlap = std::stod(overlap);
    cases.push_back(row);
  }
  return cases;
}

TEST(RealScans, BunnyPairsOfGreatOverlap) {
  if (!std::filesystem::exists(folder / "cases.csv"))
    GTEST_SKIP() << "left out: the real scans are not there (" << folder.string() << "); nothing was tested here";
  const std::vector<Case> cases = read_cases();
  ASSERT_GE(cases.size(), 10u) << "cases.csv no longer lists the bunny pairs this test is about";
  std::uint64_t seed = 0;
  for (const Case& row : cases) {
    SCOPED_TRACE(row.name);
    const Points stored = read_points(folder / row.source).points;
    const Points target = read_points(folder / row.target).points;
    // The files lie near their true relation: moved away first, so that no start pose helps.
    const Transformation scramble = testing::random_motion(++seed, 6.0 * testing::radius_of_gyration(stored));
    const Result result = align(testing::moved(scramble, stored), target);
    EXPECT_TRUE(result.registered) << result.reason;
    const Transformation truth = read_transformation(folder / row.truth);
    const PoseError error = pose_error(result.target_from_source * scramble, truth, testing::centroid(stored));
    EXPECT_LT(error.rotation_rad, row.max_rotation_error_deg * EIGEN_PI / 180.0);
    EXPECT_LT(error.centroid_displacement, row.max_translation_error);
  }
}

}  // namespace
}  // namespace igsp
