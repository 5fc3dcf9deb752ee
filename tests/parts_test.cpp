// A cloud of several scans, each with its own viewpoint: what must hold of `align` whatever the scans are.
#include <gtest/gtest.h>

#include "igsp/archive.hpp"
#include "scenes.hpp"

namespace igsp {
namespace {

using testing::moved;

/// Three stations of a simulated building: the target is one, the source two of them in one frame.
class Parts : public ::testing::Test {
 protected:
  Parts() {
    SimulationOptions simulated;
    simulated.points = 20000;
    simulated.stations = 3;
    simulated.seed = 7;
    const std::vector<SimulatedScan> scans = simulate("indoor", simulated);
    target_ = scans[0].points;
    target_from_source_ = scans[0].world_from_scanner.inverse() * scans[1].world_from_scanner;
    for (const std::size_t i : {1, 2}) {
      const Transformation first_from_this = scans[1].world_from_scanner.inverse() * scans[i].world_from_scanner;
      stations_.push_back({moved(first_from_this, scans[i].points), first_from_this.translation()});
    }
  }

  struct Station {
    Points points;
    Eigen::Vector3d viewpoint;
  };

  Scan target() const { return {target_, Eigen::Vector3d::Zero()}; }

  static std::string bits_of(Result result) {
    result.timings_s.clear();
    for (IterationRecord& record : result.iterations) record.seconds = 0;
    result.options.threads = 0;
    return to_bytes(result);
  }

  Points target_;
  Transformation target_from_source_;
  std::vector<Station> stations_;
};

Scan with_parts(const Points& points, std::vector<ScanPart> parts) {
  Scan scan(points);
  scan.parts = std::move(parts);
  return scan;
}

Points joined(const Points& one, const Points& other) {
  Points points = one;
  points.insert(points.end(), other.begin(), other.end());
  return points;
}

TEST_F(Parts, OnePartIsAScan) {
  const auto& [points, viewpoint] = stations_[0];
  const Result scan = align({points, viewpoint}, target()),
               part = align(with_parts(points, {{points.size(), viewpoint}}), target()),
               among_empty = align(with_parts(points, {{0, {}}, {points.size(), viewpoint}, {0, viewpoint}}), target());
  EXPECT_TRUE(scan.source.viewpoint);
  EXPECT_EQ(bits_of(scan), bits_of(part));
  EXPECT_EQ(bits_of(scan), bits_of(among_empty));
  const Result unknown = align(points, target()), parts = align(with_parts(points, {{points.size(), {}}}), target());
  EXPECT_EQ(bits_of(unknown), bits_of(parts));
}

TEST_F(Parts, NeitherTheirOrderNorTheThreadsMatter) {
  const auto& [one, two] = std::tie(stations_[0], stations_[1]);
  const Points points = joined(one.points, two.points), turned = joined(two.points, one.points);
  const Scan source = with_parts(points, {{one.points.size(), one.viewpoint}, {two.points.size(), two.viewpoint}}),
             other = with_parts(turned, {{two.points.size(), two.viewpoint}, {one.points.size(), one.viewpoint}});
  Options options;
  options.threads = 1;
  const Result result = align(source, target(), options);
  EXPECT_TRUE(result.registered) << result.reason;
  ASSERT_EQ(result.source.part_viewpoints.size(), 2u);
  EXPECT_LT((result.source.part_viewpoints[1] - two.viewpoint).norm(), 1e-9);
  EXPECT_FALSE(result.source.viewpoint);
  EXPECT_GT(result.evidence.free_space.target->in_view, 100u);
  options.threads = 3;
  EXPECT_EQ(bits_of(align(source, target(), options)), bits_of(result));
  Result of_other = align(other, target(), options);
  std::swap(of_other.source.part_viewpoints[0], of_other.source.part_viewpoints[1]);
  EXPECT_EQ(bits_of(of_other), bits_of(result));
}

// Far beyond what single precision holds, so that the method computes in another unit.
TEST_F(Parts, TheUnitOfLengthDoesNotMatter) {
  const auto &one = stations_[0], &two = stations_[1];
  const auto violation_in = [&](double unit) {
    Points source = joined(one.points, two.points), target = target_;
    for (Points* points : {&source, &target}) {
      for (Eigen::Vector3d& point : *points) point *= unit;
    }
    const Scan scan =
        with_parts(source, {{one.points.size(), unit * one.viewpoint}, {two.points.size(), unit * two.viewpoint}});
    Transformation truth = target_from_source_;
    truth.translation() *= unit;
    const Result result = align(scan, target, truth);
    EXPECT_LT((result.source.part_viewpoints[1] - unit * two.viewpoint).norm(), 1e-9 * unit);
    return result.evidence.free_space;
  };
  const FreeSpace metres = violation_in(1), tiny = violation_in(0x1p30);
  EXPECT_GT(metres.target->in_view, 100u);
  EXPECT_EQ(metres.target->in_view, tiny.target->in_view);
  EXPECT_EQ(metres.target->contradicting, tiny.target->contradicting);
}

TEST_F(Parts, FeaturesKeepThem) {
  const auto& [one, two] = std::tie(stations_[0], stations_[1]);
  const Points points = joined(one.points, two.points);
  Options options;
  options.scale.voxel_size = 0.1;
  const Scan scan = with_parts(points, {{one.points.size(), {}}, {two.points.size(), two.viewpoint}});
  const Features features = extract_features(scan, options), alone = extract_features(points, options);
  EXPECT_FALSE(features.viewpoint);
  ASSERT_EQ(features.parts.size(), 1u);
  EXPECT_LT((features.parts[0].viewpoint + features.origin - two.viewpoint).norm(), 1e-9);
  EXPECT_LT(features.parts[0].fine_points.size(), features.fine_points.size());
  EXPECT_EQ(features.fine_points, alone.fine_points);  // what is registered is the whole cloud
  const Features target = extract_features(target_, options);
  const Result staged = align(features_from_bytes(to_bytes(features)), target, options),
               direct = align(scan, target_, options);
  EXPECT_EQ(staged.confidence, direct.confidence);
  EXPECT_EQ(staged.evidence.free_space.target->in_view, direct.evidence.free_space.target->in_view);
}

TEST_F(Parts, ThoseThatAreNotTheCloudsAreRefused) {
  const Points& points = stations_[0].points;
  EXPECT_THROW(align(with_parts(points, {{points.size() - 1, {}}}), target()), InvalidArgument);
  EXPECT_THROW(extract_features(with_parts(points, {{points.size() + 1, {}}})), InvalidArgument);
  EXPECT_THROW(align(target(), with_parts(points, {{points.size(), Eigen::Vector3d(NAN, 0, 0)}})), InvalidArgument);
}

}  // namespace
}  // namespace igsp
