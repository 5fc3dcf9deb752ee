#pragma once

#include <cstdint>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp {

/// A viewpoint more than a million sizes of the cloud away, drawn nearer along its direction: lines of sight are
/// parallel to a millionth, and farther away digits would be lost or squares overflow. `size` of the cloud about
/// `centre`.
Eigen::Vector3d not_too_far(const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& centre, double size);

/// Directions from a viewpoint in numbered cells: the six faces of a cube about it, or one image of a cloud that is far
/// away, so that its cells stay small against the cloud.
class DirectionImage {
 public:
  /// Cells are about `cells_per_face` to a right angle, or to the width of a cloud within `radius` of `centre` that
  /// does not surround the viewpoint.
  DirectionImage(const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& centre, double radius, int cells_per_face);

  static constexpr std::uint32_t nowhere = ~std::uint32_t{0};
  /// The cell of a point, or nowhere: at the viewpoint, or outside the image.
  std::uint32_t cell_of(const Eigen::Vector3d& point) const;
  std::uint32_t cells() const { return (far_ ? 1u : 6u) * size_ * size_; }

 private:
  Eigen::Vector3d viewpoint_;
  bool far_;
  Eigen::Matrix3d image_from_cloud_ = Eigen::Matrix3d::Identity();
  double half_width_ = 1;  // of an image at unit distance
  std::uint32_t size_;
};

}  // namespace igsp
