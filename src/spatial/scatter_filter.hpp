#pragma once

#include <cstdint>
#include <vector>

#include "spatial/scale.hpp"

namespace igsp {

/// Side of the cells that tell surfaces from scattered noise [voxels]: a surface fills about nine voxels of one.
inline constexpr double scatter_cell = 3.0;

/// Noise that is scattered over the convex hull (dust, multipath, artificial outliers), as so many points in a cube.
/// None for most clouds.
struct ScatteredNoise {
  double points = 0;
  double side = 1;  ///< of the cube, > 0

  /// Points that the noise puts into a cube of this side.
  double points_in(double other_side) const;
};

/// Surfaces leave a quarter and more of the hull's blocks empty, noise does not: from the quartile of the points in a
/// block.
ScatteredNoise scattered_noise(PointView cloud, const Bounds& bounds);

/// Tells the points of surfaces from scattered noise: a cell is a surface's if it holds more points than the noise
/// would put there.
class ScatterFilter {
 public:
  /// Counts the cloud's points in cubic cells, where that can make a difference. `cell_size` > 0.
  ScatterFilter(PointView cloud, const Bounds& bounds, const ScatteredNoise& noise, double cell_size);

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
