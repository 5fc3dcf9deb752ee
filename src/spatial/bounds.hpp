#pragma once

#include <string_view>

#include "igsp/point_cloud.hpp"

namespace igsp {

struct Bounds {
  Eigen::Vector3d min;
  Eigen::Vector3d max;
  double diagonal() const { return (max - min).norm(); }
};

/// Throws InvalidArgument naming `name` for an empty cloud or a non-finite point.
Bounds bounds_of(PointView cloud, std::string_view name);

/// The origin that a cloud's coordinates are taken relative to. It is a corner plus half an extent, so that it moves
/// exactly with the cloud: a pair in survey coordinates gives the same differences, hence the same result.
Eigen::Vector3d centre_of(const Bounds& bounds);

}  // namespace igsp
