#pragma once

#include <cstdint>
#include <vector>

#include "spatial/scale.hpp"

namespace igsp {

/// Side of the cells that tell surfaces from scattered noise [voxels]: a surface fills about nine voxels of one.
inline constexpr double scatter_cell = 3.0;

/// The density of noise that is scattered over the convex hull (dust, multipath, artificial outliers) [points per unit of
/// volume]. Surfaces leave a quarter and more of the hull's blocks empty, noise does not: from the quartile of the
/// points in a block. 0 for most clouds.
double scatter_density(PointView cloud, const Bounds& bounds);

/// Tells the points of surfaces from scattered noise: a cell is a surface's if it holds more points than noise of this
/// density would put there.
class ScatterFilter {
 public:
  /// Counts the cloud's points in cubic cells, where that can make a difference. `cell_size` > 0.
  ScatterFilter(PointView cloud, const Bounds& bounds, double density, double cell_size);

  /// No noise to speak of, or so much would go that it is no noise.
  bool keeps_all() const { return least_count_ <= 1; }
  bool keeps(const Eigen::Vector3d& point) const { return keeps_all() || counts_[slot_of(point)] >= least_count_; }

 private:
  std::size_t slot_of(const Eigen::Vector3d& point) const;

  Eigen::Vector3d corner_;
  double inverse_cell_size_;
  std::uint32_t least_count_;
  std::vector<std::uint32_t> counts_;  // per slot of a hash table without keys: few cells share a slot
};

/// The points that the filter keeps.
Points without_scatter(PointView cloud, const ScatterFilter& filter);

}  // namespace igsp
