#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace igsp {

/// Hash of the cell [0, 2^63)^3 that a place lies in; `place` in cells, >= 0. The high bits are the well mixed ones.
inline std::uint64_t cell_hash(const Eigen::Vector3d& place) {
  const std::uint64_t key = static_cast<std::uint64_t>(place.x()) * 0x9E3779B97F4A7C15ull ^
                            static_cast<std::uint64_t>(place.y()) * 0xC2B2AE3D27D4EB4Full ^
                            static_cast<std::uint64_t>(place.z()) * 0x165667B19E3779F9ull;
  return (key ^ (key >> 29)) * 0xBF58476D1CE4E5B9ull;
}

}  // namespace igsp
