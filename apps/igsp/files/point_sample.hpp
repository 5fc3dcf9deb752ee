#pragma once

#include <cstddef>
#include <cstdint>

#include "igsp/point_cloud.hpp"

namespace igsp::cli {

/// The points of a stream: all of them in their order or, of more than `limit`, a sample of at most half as many that
/// depends on which points came, not on their order. A point is in the sample if its hash is small enough; equal points
/// count once, since they share it.
class PointSample {
 public:
  explicit PointSample(std::size_t limit) : limit_(limit) {}

  void add(PointView chunk);

  /// A sample is sorted by x, y and z.
  Points take();

 private:
  void shrink();
  bool is_in(const Eigen::Vector3d& point) const;

  std::size_t limit_, seen_ = 0;
  int halvings_ = 0;  // a share of 2^-halvings of the different points is kept
  Points kept_;
};

}  // namespace igsp::cli
