#pragma once

#include <span>
#include <vector>

#include "igsp/network.hpp"
#include "network/pose_equations.hpp"

namespace igsp {

/// Throws InvalidArgument for control of a scan that is not there, or with a number out of range.
void check_control(const NetworkOptions& options, std::size_t scans);

/// What a control's position is of, in the scan's frame: its scanner, or the origin of its frame.
Eigen::Vector3d station_of(const Features& features);

/// Takes every component whose control says where it lies there, as a whole, and says which cannot be. `stations` by
/// scan. Returns by component whether it was placed.
std::vector<bool> move_to_control(Network& network, std::span<const Eigen::Vector3d> stations,
                                  const NetworkOptions& options);

/// How far the scans are from their control, of the components that it placed.
void measure_control(Network& network, std::span<const Eigen::Vector3d> stations, const NetworkOptions& options,
                     const std::vector<bool>& placed);

/// The control of a scan at its pose, for a step about `centre`. `station` as above; all lengths in one unit.
PriorFactor prior_of(const ControlPose& control, const Transformation& world_from_scan, const Eigen::Vector3d& station,
                     const Eigen::Vector3d& centre);

}  // namespace igsp
