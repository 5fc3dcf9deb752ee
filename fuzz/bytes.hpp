#pragma once

// Arbitrary bytes as numbers, points and clouds.

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "igsp/point_cloud.hpp"

namespace igsp::fuzzing {

/// Bytes one after the other; zeros when they are used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool empty() const { return size_ == 0; }
  std::uint8_t byte() { return take<std::uint8_t>(); }
  double number() { return take<double>(); }

  template <typename T>
  T take() {
    T value{};
    const std::size_t count = std::min(sizeof(T), size_);
    std::memcpy(&value, data_, count);
    data_ += count, size_ -= count;
    return value;
  }

  /// Mostly a coordinate as clouds have them, in steps that coincide; sometimes any double there is.
  double coordinate() {
    const std::uint8_t kind = byte();
    return kind < 250 ? 0.1 * byte() + 0.001 * kind : number();
  }
  Eigen::Vector3d point() {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    return {x, y, z};
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// Single points, and flat pieces of a surface, so that keypoints, frames and matches come of it; at most `most`
/// things.
inline Points cloud(Bytes& bytes, std::size_t most) {
  constexpr std::size_t most_points = 3000;
  Points points;
  for (std::size_t thing = 0; thing < most && points.size() < most_points && !bytes.empty(); ++thing) {
    const std::uint8_t kind = bytes.byte();
    const Eigen::Vector3d corner = bytes.point();
    if (kind < 128) {
      points.push_back(corner);
      continue;
    }
    const Eigen::Vector3d u = 0.3 * bytes.point(), v = 0.3 * bytes.point();
    const int rows = 2 + kind % 16, columns = 2 + kind / 8 % 16;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) points.push_back(corner + i * u / rows + j * v / columns);
    }
  }
  return points;
}

}  // namespace igsp::fuzzing
