#include "network/control.hpp"

#include <fmt/format.h>

#include <cmath>

#include "estimation/rigid_fit.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

bool is_positive(double number) {
  return std::isfinite(number) && number > 0;
}

// Of one component.
std::vector<const ControlPose*> control_of(const Network& network, std::size_t component,
                                           const NetworkOptions& options) {
  std::vector<const ControlPose*> found;
  for (const ControlPose& one : options.control) {
    if (network.scans[one.scan].component == component) found.push_back(&one);
  }
  return found;
}

// The motion of the component that the best known rotation asks for, else that of the positions.
std::optional<Transformation> motion_to(const std::vector<const ControlPose*>& control, const Network& network,
                                        std::span<const Eigen::Vector3d> stations, int degrees_of_freedom) {
  const ControlPose* best = nullptr;
  std::vector<PointPair> pairs;
  for (const ControlPose* one : control) {
    const double weight = 1 / (one->position_sigma * one->position_sigma);
    pairs.push_back({network.scans[one->scan].world_from_scan * stations[one->scan], one->position, weight});
    if (one->rotation && (!best || one->rotation_sigma_rad < best->rotation_sigma_rad)) best = one;
  }
  if (!best) return rigid_fit(pairs, degrees_of_freedom);
  const NetworkScan& scan = network.scans[best->scan];
  Eigen::Matrix3d turn = best->rotation->toRotationMatrix() * scan.world_from_scan.linear().transpose();
  if (degrees_of_freedom == 4) {
    turn = Eigen::AngleAxisd(std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1)), Eigen::Vector3d::UnitZ());
  }
  Transformation motion = Transformation::Identity();
  motion.linear() = turn;
  motion.translation() = best->position - turn * (scan.world_from_scan * stations[best->scan]);
  return motion;
}

void move(NetworkScan& scan, const Transformation& motion) {
  scan.world_from_scan = motion * scan.world_from_scan;
  scan.centre = motion * scan.centre;
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = motion.linear();
  scan.covariance = turn * scan.covariance * turn.transpose();
}

}  // namespace

void check_control(const NetworkOptions& options, std::size_t scans) {
  if (options.fixed_scan && *options.fixed_scan >= scans) {
    throw InvalidArgument(fmt::format("fixed_scan is {}; there are {} scans", *options.fixed_scan, scans));
  }
  for (const ControlPose& one : options.control) {
    if (one.scan >= scans)
      throw InvalidArgument(fmt::format("control of scan {}; there are {} scans", one.scan, scans));
    if (!one.position.allFinite() || !is_positive(one.position_sigma)) {
      throw InvalidArgument(
          fmt::format("control of scan {}: the position must be finite and its sigma, {}, greater than 0", one.scan,
                      one.position_sigma));
    }
    if (one.rotation && !(std::abs(one.rotation->norm() - 1) < 1e-3 && is_positive(one.rotation_sigma_rad))) {
      throw InvalidArgument(
          fmt::format("control of scan {}: the rotation must be a unit quaternion and its sigma, {}, greater than 0",
                      one.scan, one.rotation_sigma_rad));
    }
  }
}

Eigen::Vector3d station_of(const Features& features) {
  return features.viewpoint ? Eigen::Vector3d(features.origin + *features.viewpoint) : Eigen::Vector3d::Zero();
}

std::vector<bool> move_to_control(Network& network, std::span<const Eigen::Vector3d> stations,
                                  const NetworkOptions& options) {
  std::vector<bool> placed(network.components.size(), false);
  for (std::size_t c = 0; c < network.components.size(); ++c) {
    const std::vector<const ControlPose*> control = control_of(network, c, options);
    if (control.empty()) continue;
    const bool levelled = options.pair.degrees_of_freedom == 4;
    const auto motion = motion_to(control, network, stations, options.pair.degrees_of_freedom);
    if (!motion) {
      network.warnings.push_back(
          fmt::format("the control of component {} ({} scans) does not say where it lies: {} positions, where a pose "
                      "or {} are needed",
                      c, network.components[c].size(), control.size(),
                      levelled ? "two positions apart from each other" : "three positions on no line"));
      continue;
    }
    for (const std::size_t i : network.components[c]) move(network.scans[i], *motion);
    placed[c] = true;
  }
  return placed;
}

void measure_control(Network& network, std::span<const Eigen::Vector3d> stations, const NetworkOptions& options,
                     const std::vector<bool>& placed) {
  for (const ControlPose& one : options.control) {
    NetworkScan& scan = network.scans[one.scan];
    if (placed[scan.component]) {
      scan.control_residual = (scan.world_from_scan * stations[one.scan] - one.position).norm();
    }
  }
}

PriorFactor prior_of(const ControlPose& control, const Transformation& world_from_scan, const Eigen::Vector3d& station,
                     const Eigen::Vector3d& centre) {
  PriorFactor prior{control.scan, Matrix6::Zero(), Vector6::Zero()};
  // The station moves as the scan's step about its centre has it; its residual is seen from the scan's frame.
  const Matrix6 to_station = transport(Transformation::Identity(), centre, station);
  const Eigen::Matrix<double, 3, 6> change = to_station.bottomRows<3>();
  const Eigen::Matrix3d scan_from_world = world_from_scan.linear().transpose();
  const Eigen::Vector3d residual = scan_from_world * (world_from_scan * station - control.position);
  const double weight = 1 / (control.position_sigma * control.position_sigma);
  prior.information = weight * change.transpose() * change;
  prior.gradient = weight * change.transpose() * residual;
  if (control.rotation) {
    Transformation difference = Transformation::Identity();
    difference.linear() = control.rotation->toRotationMatrix().transpose() * world_from_scan.linear();
    const double stiffness = 1 / (control.rotation_sigma_rad * control.rotation_sigma_rad);
    prior.information.topLeftCorner<3, 3>().diagonal().array() += stiffness;
    prior.gradient.head<3>() += stiffness * step_about(Eigen::Vector3d::Zero(), difference).head<3>();
  }
  return prior;
}

}  // namespace igsp
