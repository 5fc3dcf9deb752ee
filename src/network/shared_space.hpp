#pragma once

#include <cstdint>
#include <unordered_set>

#include "igsp/features.hpp"

namespace igsp {

/// Where a scan's points are, coarsely: enough to say whether two scans overlap where a network puts them.
class Space {
 public:
  explicit Space(const Features& features);

  const Points& samples() const { return samples_; }
  bool holds(const Eigen::Vector3d& point) const;

 private:
  Points samples_;  // some points, in the scan's frame
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double cell_ = 1;
  std::unordered_set<std::uint64_t> cells_;
};

/// Share of the points of one scan that lie at points of the other, the smaller of both directions, [0, 1].
double shared_space(const Space& a, const Transformation& world_from_a, const Space& b,
                    const Transformation& world_from_b);

}  // namespace igsp
