#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp::cli {

/// The points of a stream: all of them in their order or, of more than `limit`, a sample of at most half as many and a
/// million that depends on which points came, not on their order. A point is in the sample if its hash is small enough;
/// equal points count once, since they share it. Of several scans in one stream each is sampled like that.
class PointSample {
 public:
  /// `expected`: how many will come, if that is known; a sample is then one from the start.
  PointSample(std::size_t limit, std::size_t expected);

  /// `part`: of which scan all of the chunk is, from 0; those of one scan come one after the other.
  void add(PointView chunk, std::size_t part = 0);

  /// A sample is sorted by x, y and z, scan by scan.
  Points take();
  /// How many of `take` are of each scan, once it has been called.
  const std::vector<std::size_t>& part_sizes() const { return sizes_; }

 private:
  void shrink();
  template <typename LeaveOut>
  void keep_of_each(const LeaveOut& leave_out);
  bool is_in(const Eigen::Vector3d& point) const;

  std::size_t limit_, sampled_, seen_ = 0;  // of a sample at most `sampled_`
  int halvings_ = 0;                        // a share of 2^-halvings of the different points is kept
  std::vector<std::size_t> sizes_ = {0};    // of `kept_`, by scan
  Points kept_;
};

}  // namespace igsp::cli
