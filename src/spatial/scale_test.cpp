#include "spatial/scale.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "core/core_testing.hpp"
#include "igsp/errors.hpp"
#include "spatial/voxel_grid.hpp"

namespace igsp {
namespace {

using testing::BumpySurface;
using testing::Random;

Points surface(std::uint64_t seed, std::size_t size, double half_side) {
  Random random(seed);
  const BumpySurface shape(random);
  return shape.sample(random, size, half_side);
}

Points scaled(const Points& points, double factor) {
  Points result = points;
  for (Eigen::Vector3d& point : result) point *= factor;
  return result;
}

double voxel_count(const Points& points, double voxel_size) {
  return static_cast<double>(voxel_centroids(points, bounds_of(points, "cloud").min, voxel_size).size());
}

template <typename Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Bounds, HoldTheCloud) {
  const Points points{{1, -2, 3}, {-1, 5, 2}, {0, 0, 9}};
  const Bounds bounds = bounds_of(points, "cloud");
  EXPECT_EQ(bounds.min, Eigen::Vector3d(-1, -2, 2));
  EXPECT_EQ(bounds.max, Eigen::Vector3d(1, 5, 9));
  EXPECT_DOUBLE_EQ(bounds.diagonal(), std::sqrt(4.0 + 49.0 + 49.0));
  EXPECT_EQ(centre_of(bounds), Eigen::Vector3d(0, 1.5, 5.5));
}

TEST(Bounds, RefuseAnEmptyCloudByName) {
  EXPECT_NE(error_of([] { bounds_of(Points{}, "target"); }).find("target"), std::string::npos);
}

TEST(Bounds, RefuseEveryNonFiniteCoordinateByPlace) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      Points points(5, Eigen::Vector3d(1, 2, 3));
      points[3][axis] = value;
      const std::string error = error_of([&] { bounds_of(points, "source"); });
      EXPECT_NE(error.find("source: point 3"), std::string::npos) << error;
    }
  }
}

TEST(VoxelSize, ReachesTheTargetCountOnASurface) {
  const Points cloud = surface(1, 200000, 10);
  for (const int target : {3000, 12000, 40000}) {
    ScaleOptions options;
    options.target_points = target;
    EXPECT_NEAR(voxel_count(cloud, choose_voxel_size(cloud, cloud, options)), target, 0.05 * target);
  }
}

TEST(VoxelSize, CountsBothCloudsByTheirGeometricMean) {
  const Points small = surface(2, 150000, 5), large = surface(3, 300000, 15);
  const double voxel_size = choose_voxel_size(small, large, {});
  EXPECT_EQ(choose_voxel_size(large, small, {}), voxel_size);
  EXPECT_NEAR(std::sqrt(voxel_count(small, voxel_size) * voxel_count(large, voxel_size)), 12000, 0.05 * 12000);
}

TEST(VoxelSize, IsNoFinerThanEitherCloudsSpacing) {
  const Points sparse = surface(4, 2000, 10), dense = surface(4, 100000, 10);
  for (const double voxel_size : {choose_voxel_size(sparse, dense, {}), choose_voxel_size(dense, sparse, {})}) {
    EXPECT_NEAR(voxel_count(sparse, voxel_size), 0.6 * 2000, 0.05 * 0.6 * 2000);
  }
}

TEST(VoxelSize, ScalesWithTheUnitOfLength) {
  const Points source = surface(5, 30000, 10), target = surface(6, 20000, 10);
  const double metres = choose_voxel_size(source, target, {});
  EXPECT_EQ(choose_voxel_size(scaled(source, 1024), scaled(target, 1024), {}), 1024 * metres);
  for (const double unit : {1000.0, 1.0 / 1000}) {
    EXPECT_NEAR(choose_voxel_size(scaled(source, unit), scaled(target, unit), {}), unit * metres, 1e-9 * unit * metres);
  }
}

TEST(VoxelSize, AndCentreMoveExactlyWithTheCloud) {
  Points cloud;  // multiples of 2^-12, so that the shift itself is exact
  for (const Eigen::Vector3d& p : surface(7, 30000, 10)) cloud.push_back((p * 4096).array().round() / 4096);
  const Eigen::Vector3d shift(500000, 5000000, 100);
  Points shifted = cloud;
  for (Eigen::Vector3d& point : shifted) point += shift;
  EXPECT_EQ(choose_voxel_size(shifted, shifted, {}), choose_voxel_size(cloud, cloud, {}));
  EXPECT_EQ(centre_of(bounds_of(shifted, "cloud")), centre_of(bounds_of(cloud, "cloud")) + shift);
}

TEST(VoxelSize, OfTheUserIsTaken) {
  ScaleOptions options;
  options.voxel_size = 0.123;
  EXPECT_EQ(choose_voxel_size(surface(8, 100, 1), surface(9, 100, 1), options), 0.123);
  EXPECT_EQ(choose_voxel_size(Points(9, {1, 2, 3}), Points(9, {1, 2, 3}), options), 0.123);
}

TEST(VoxelSize, NeedsTwoDifferentPoints) {
  const Points same(1000, Eigen::Vector3d(1, 2, 3)), one{{5, 5, 5}};
  EXPECT_THROW(choose_voxel_size(same, same, {}), InvalidArgument);
  EXPECT_THROW(choose_voxel_size(one, one, {}), InvalidArgument);
  EXPECT_THROW(choose_voxel_size(Points{}, one, {}), InvalidArgument);
  EXPECT_THROW(choose_voxel_size(one, Points{}, {}), InvalidArgument);
}

// Many points at few places look like a dense cloud that asks for ever finer voxels.
TEST(VoxelSize, SuitsTheVoxelFilterHoweverFewThePlaces) {
  for (const std::size_t places : {2, 3, 10}) {
    Random random(places);
    const Points distinct = testing::random_points(random, places, 10);
    Points cloud;
    for (int copy = 0; copy < 20000; ++copy) cloud.insert(cloud.end(), distinct.begin(), distinct.end());
    const double voxel_size = choose_voxel_size(cloud, cloud, {});
    EXPECT_NO_THROW(EXPECT_EQ(voxel_count(cloud, voxel_size), places));
  }
}

}  // namespace
}  // namespace igsp
