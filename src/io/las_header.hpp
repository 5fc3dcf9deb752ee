#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "igsp/point_cloud.hpp"
#include "io/input_file.hpp"

namespace igsp::io {

/// What the header of a LAS file (ASPRS, LAS 1.0 to 1.4) says of its points, which are not compressed.
struct LasHeader {
  std::uint64_t points_start = 0;  ///< byte of the first point
  int point_format = 0;            ///< 0 to 10
  std::size_t record_length = 0;   ///< at least that of the format; what lies behind it are extra bytes
  std::uint64_t count = 0;
  Eigen::Vector3d scale, offset;  ///< coordinate = offset + scale * stored integer
  std::string extra_bytes;        ///< content of the record that describes them, 192 bytes each; mostly empty

  /// Relative to `offset`.
  Eigen::Vector3d local_position(const char* record) const;
  /// As the coordinates of every reader: two roundings, no more.
  Eigen::Vector3d position(const char* record) const;
  /// Classified as noise (7 and 18), or withheld: what their maker asks to leave out.
  bool is_noise(const char* record) const;
};

/// Scale and offset (six doubles) and bounds (six) lie together in every version.
inline constexpr std::size_t las_scale_begin = 131, las_bounds_begin = 179, las_bounds_end = 227;
/// Magnitude of a scale or an offset beyond which coordinates would overflow.
inline constexpr double las_largest = 1e30;

/// The bytes of a point record that belong to its format.
std::size_t las_format_length(int point_format);

/// Reads up to the first point and looks at the records behind the points. Throws FileError, also where a count does
/// not fit into the file and where the points are compressed.
LasHeader read_las_header(InputFile& file);

/// True of a LAS file whose points are compressed (LAZ), whatever its name; false also if it cannot be opened.
bool is_compressed_las(const std::filesystem::path& path);

/// A number as LAS stores it, from unaligned bytes.
template <typename Number>
Number las_number(const char* bytes) {
  std::array<char, sizeof(Number)> raw;
  std::copy_n(bytes, raw.size(), raw.begin());
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
  return std::bit_cast<Number>(raw);
}

template <typename Number>
void put_las_number(char* bytes, Number value) {
  auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
  std::ranges::copy(raw, bytes);
}

}  // namespace igsp::io
