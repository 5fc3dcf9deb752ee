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

/// Cells from the origin along an axis that a key tells apart.
inline constexpr double cell_reach = 1 << 20;
inline constexpr int cell_key_bits = 21;  // an axis
static_assert(cell_reach == 1 << (cell_key_bits - 1));

/// Another number for every cell; `cell` whole, in [-cell_reach, cell_reach).
inline std::uint64_t cell_key(const Eigen::Vector3d& cell) {
  const auto biased = [](double c) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(c + cell_reach)); };
  return biased(cell.z()) << (2 * cell_key_bits) | biased(cell.y()) << cell_key_bits | biased(cell.x());
}

/// The cell of a key.
inline Eigen::Vector3d cell_of(std::uint64_t key) {
  constexpr std::uint64_t mask = (std::uint64_t{1} << cell_key_bits) - 1;
  const auto axis = [&](int i) { return static_cast<double>(key >> (i * cell_key_bits) & mask) - cell_reach; };
  return {axis(0), axis(1), axis(2)};
}

}  // namespace igsp
