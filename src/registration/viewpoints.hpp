#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "igsp/features.hpp"

namespace igsp {

/// Where the points of a cloud were seen from, as far as that is known.
class Viewpoints {
 public:
  /// All from one place.
  explicit Viewpoints(const std::optional<Eigen::Vector3d>& viewpoint = {});

  /// `points` stand for the cloud's surface. Where the cloud is several scans, that of the nearest point saw it.
  Viewpoints(const Features& cloud, PointView points);

  /// Of point i; null where it is not known.
  const Eigen::Vector3d* of(std::size_t i) const {
    const std::size_t k = scan_of_point_.empty() ? 0 : scan_of_point_[i];
    return k < viewpoints_.size() ? &viewpoints_[k] : nullptr;
  }

 private:
  Points viewpoints_;                         // of the scans
  std::vector<std::uint32_t> scan_of_point_;  // beyond the last: unknown; empty where there is one scan
};

}  // namespace igsp
