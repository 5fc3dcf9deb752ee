#include "network/control.hpp"

#include <gtest/gtest.h>

#include "core/core_testing.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

Transformation pose(double x, double y, double yaw) {
  Transformation pose = Transformation::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(x, y, 1);
  return pose;
}

// Four scans in one frame of their own; `world` is where control has them.
struct Site {
  Network network;
  NetworkOptions options;
  std::vector<Eigen::Vector3d> stations;
  Transformation world = pose(100, 200, 2);
  std::vector<Transformation> own;

  Site() {
    own = {pose(0, 0, 0), pose(10, 0, 1), pose(0, 10, 2), pose(20, 0, 3)};
    network.scans.resize(4);
    network.components = {{0, 1, 2, 3}};
    for (std::size_t i = 0; i < 4; ++i) {
      network.scans[i].world_from_scan = own[i];
      network.scans[i].centre = own[i] * Eigen::Vector3d(1, 2, 3);
      network.scans[i].covariance.diagonal() << 1, 2, 3, 4, 5, 6;
      stations.emplace_back(0.1 * i, 0, 1);
    }
  }
  void know(std::size_t scan, bool rotation = false) {
    ControlPose& one = options.control.emplace_back();
    one = {scan, world * own[scan] * stations[scan], 0.01, {}, 0};
    if (rotation) {
      one.rotation = Eigen::Quaterniond(world.linear() * own[scan].linear());
      one.rotation_sigma_rad = 0.01;
    }
  }
  bool moved() {
    const bool placed = move_to_control(network, stations, options)[0];
    for (std::size_t i = 0; i < 4 && placed; ++i) {
      EXPECT_LT((network.scans[i].world_from_scan.matrix() - (world * own[i]).matrix()).norm(), 1e-9) << i;
      EXPECT_LT((network.scans[i].centre - world * own[i] * Eigen::Vector3d(1, 2, 3)).norm(), 1e-9);
      EXPECT_NEAR(network.scans[i].covariance.trace(), 21, 1e-9);
    }
    EXPECT_EQ(network.warnings.empty(), placed);
    return placed;
  }
};

TEST(Control, ThreePositionsOnNoLineOrOnePoseSayWhereAComponentLies) {
  Site three, pose;
  for (const std::size_t scan : {0, 1, 2}) three.know(scan);
  EXPECT_TRUE(three.moved());
  pose.know(3, true);
  EXPECT_TRUE(pose.moved());
  measure_control(pose.network, pose.stations, pose.options, {true});
  EXPECT_NEAR(*pose.network.scans[3].control_residual, 0, 1e-9);
  EXPECT_FALSE(pose.network.scans[0].control_residual);
}

TEST(Control, TwoPositionsDoSoForLevelledScansOnly) {
  Site two;
  two.know(0);
  two.know(1);
  EXPECT_FALSE(two.moved());
  EXPECT_NE(two.network.warnings[0].find("does not say where it lies: 2 positions"), std::string::npos);
  Site levelled;
  levelled.options.pair.degrees_of_freedom = 4;
  levelled.know(0);
  levelled.know(1);
  EXPECT_TRUE(levelled.moved());
}

// The gradient of the energy and what it is a step away.
TEST(Control, PriorIsTheQuadraticOfItsEnergy) {
  testing::Random random(1);
  const Transformation at = random.motion(5);
  const Eigen::Vector3d station(1, 2, 3), centre(4, -1, 2);
  ControlPose control{0, at * station + Eigen::Vector3d(0.02, -0.01, 0.03), 0.1, {}, 0.2};
  control.rotation = Eigen::Quaterniond(at.linear() * Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitX()));
  const auto energy = [&](const Vector6& step) {
    const Transformation moved = at * motion_about(centre, step);
    const Eigen::Vector3d off = moved * station - control.position;
    const Eigen::AngleAxisd turn(control.rotation->toRotationMatrix().transpose() * moved.linear());
    return 0.5 * (off.squaredNorm() / 0.01 + turn.angle() * turn.angle() / 0.04);
  };
  const PriorFactor prior = prior_of(control, at, station, centre);
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = Vector6::Unit(i) * 1e-4;
    EXPECT_NEAR((energy(step) - energy(-step)) / 2e-4, prior.gradient[i], 1e-3) << i;
    EXPECT_NEAR((energy(step) + energy(-step) - 2 * energy(Vector6::Zero())) / 1e-8, prior.information(i, i),
                0.02 * prior.information(i, i) + 0.1)
        << i;
  }
}

TEST(Control, NumbersOutOfRangeAreNamed) {
  NetworkOptions options;
  options.control = {{1, {0, 0, 0}, 0.1, {}, 0}};
  EXPECT_NO_THROW(check_control(options, 2));
  EXPECT_THROW(check_control(options, 1), InvalidArgument);
  options.control[0].position_sigma = 0;
  EXPECT_THROW(check_control(options, 2), InvalidArgument);
  options.control[0].position_sigma = 1;
  options.control[0].rotation = Eigen::Quaterniond(1, 1, 0, 0);
  options.control[0].rotation_sigma_rad = 1;
  EXPECT_THROW(check_control(options, 2), InvalidArgument);
  options.control.clear();
  options.fixed_scan = 2;
  EXPECT_THROW(check_control(options, 2), InvalidArgument);
}

}  // namespace
}  // namespace igsp
