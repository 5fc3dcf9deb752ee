#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/io_testing.hpp"
#include "io/las_header.hpp"

namespace igsp::io::testing {

/// A LAS file in the making, written here byte by byte.
struct LasFile {
  int minor = 2;
  int point_format = 0;
  Eigen::Vector3d scale{0.001, 0.002, 0.004}, offset{500000, 5000000, 100};
  std::vector<std::array<std::int32_t, 3>> stored;
  std::string extra;               ///< bytes behind every point of the format
  std::string records;             ///< variable length records, heads included
  std::uint32_t record_count = 0;  ///< of them
  std::string behind;              ///< what comes after the points; in LAS 1.4 extended records
  std::uint32_t extended_count = 0;
  std::vector<std::size_t> noise, withheld;  ///< which points

  std::size_t header_size() const { return minor < 3 ? 227 : minor == 3 ? 235 : 375; }
  std::size_t points_start() const { return header_size() + records.size(); }
  std::size_t record_length() const { return las_format_length(point_format) + extra.size(); }
  Eigen::Vector3d point(std::size_t i) const {
    const Eigen::Vector3d integers(stored[i][0], stored[i][1], stored[i][2]);
    return integers.cwiseProduct(scale) + offset;
  }

  /// Every byte that is no coordinate, class or flag tells its place.
  std::string record(std::size_t i) const {
    std::string bytes;
    for (std::size_t k = 0; k < las_format_length(point_format); ++k) bytes += static_cast<char>(16 + i + k);
    for (std::size_t axis = 0; axis < 3; ++axis) put_las_number(&bytes[4 * axis], stored[i][axis]);
    const bool is_noise = std::ranges::count(noise, i) > 0, is_withheld = std::ranges::count(withheld, i) > 0;
    const char kind = is_noise ? (i % 2 ? 7 : 18) : 2;
    if (point_format < 6) {
      bytes[15] = static_cast<char>(kind | 0x20 | (is_withheld ? 0x80 : 0));
    } else {
      bytes[15] = is_withheld ? 0x05 : 0x01;
      bytes[16] = kind;
    }
    return bytes + extra;
  }

  std::string bytes() const {
    std::string header(header_size(), '\x2E');
    header.replace(0, 4, "LASF");
    header[24] = 1;
    header[25] = static_cast<char>(minor);
    const auto count = static_cast<std::uint32_t>(stored.size());
    put_las_number(&header[94], static_cast<std::uint16_t>(header_size()));
    put_las_number(&header[96], static_cast<std::uint32_t>(points_start()));
    put_las_number(&header[100], record_count);
    header[104] = static_cast<char>(point_format);
    put_las_number(&header[105], static_cast<std::uint16_t>(record_length()));
    put_las_number(&header[107], minor < 4 ? count : 0);
    for (int axis = 0; axis < 3; ++axis) {
      put_las_number(&header[131] + 8 * axis, scale[axis]);
      put_las_number(&header[155] + 8 * axis, offset[axis]);
    }
    std::string points;
    for (std::size_t i = 0; i < stored.size(); ++i) points += record(i);
    if (minor >= 4) {
      put_las_number(&header[235], std::uint64_t{points_start() + points.size()});
      put_las_number(&header[243], extended_count);
      put_las_number(&header[247], std::uint64_t{count});
    }
    return header + records + points + behind;
  }
};

inline std::string las_record(std::string user, std::uint16_t number, const std::string& content) {
  user.resize(16);
  return std::string(2, '\0') + user + bytes_of(number) + bytes_of(static_cast<std::uint16_t>(content.size())) +
         std::string(32, 'd') + content;
}

inline std::string las_extended_record(std::string user, std::uint16_t number, const std::string& content) {
  user.resize(16);
  return std::string(2, '\0') + user + bytes_of(number) + bytes_of(std::uint64_t{content.size()}) +
         std::string(32, 'd') + content;
}

/// A file of every point format, with records and extra bytes, of the version that brought the format.
inline LasFile las_of_format(int point_format) {
  LasFile file;
  file.point_format = point_format;
  file.minor = point_format < 2 ? 0 : point_format < 4 ? 2 : point_format < 6 ? 3 : 4;
  file.extra = point_format % 2 ? "extra" : "";
  file.records = las_record("surveyor", 77, "field book") + "a gap";
  file.record_count = 1;
  file.behind = file.minor >= 4 ? las_extended_record("office", 5, std::string(300, 'e')) : "behind";
  file.extended_count = file.minor >= 4 ? 1 : 0;
  for (int i = 0; i < 100; ++i) {
    file.stored.push_back({1000 * i - 7, -31 * i * i, static_cast<std::int32_t>(1e5 * std::sin(i))});
  }
  return file;
}

}  // namespace igsp::io::testing
