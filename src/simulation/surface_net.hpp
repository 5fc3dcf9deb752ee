#pragma once

#include <array>
#include <vector>

#include "simulation/primitives.hpp"

namespace igsp::simulation {

/// Samples of a scalar field on a regular grid with `nodes` per side of a cube.
class Field {
 public:
  Field(const Eigen::AlignedBox3d& box, int nodes)
      : box_(box), nodes_(nodes), step_(box.sizes().x() / (nodes - 1)), values_(std::size_t(nodes) * nodes * nodes) {}

  const Eigen::AlignedBox3d& box() const { return box_; }
  int nodes() const { return nodes_; }
  std::size_t index(int i, int j, int k) const { return (std::size_t(k) * nodes_ + j) * nodes_ + i; }
  std::size_t nearest(const Eigen::Vector3d& point) const {
    const Eigen::Vector3i node = ((point - box_.min()) / step_).array().round().cast<int>();
    return index(node.x(), node.y(), node.z());
  }
  double value(std::size_t index) const { return values_[index]; }
  Eigen::Vector3d position(int i, int j, int k) const { return box_.min() + step_ * Eigen::Vector3d(i, j, k); }

  /// visit(position, value&) for every node in `part`.
  template <typename Visit>
  void visit(const Eigen::AlignedBox3d& part, const Visit& visit) {
    std::array<int, 3> low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(0, static_cast<int>(std::ceil((part.min()[axis] - box_.min()[axis]) / step_)));
      high[axis] = std::min(nodes_ - 1, static_cast<int>(std::floor((part.max()[axis] - box_.min()[axis]) / step_)));
    }
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        for (int i = low[0]; i <= high[0]; ++i) visit(position(i, j, k), values_[index(i, j, k)]);
      }
    }
  }

 private:
  Eigen::AlignedBox3d box_;
  int nodes_;
  double step_;
  std::vector<float> values_;
};

/// Triangles of the surface where the field is `level`: one vertex in every cell that the surface passes, at the mean
/// of its crossings with the cell's edges, and a quad around every crossed edge (a "surface net").
std::vector<Triangle> surface_net(const Field& field, double level);

}  // namespace igsp::simulation
