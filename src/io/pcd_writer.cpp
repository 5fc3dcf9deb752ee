#include <fmt/format.h>
#include <lzf.h>

#include <cstdint>
#include <limits>

#include "igsp/errors.hpp"
#include "io/point_writers.hpp"

namespace igsp::io {

namespace {

std::string header(std::size_t points, bool single_precision, const char* data) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE {0} {0} {0}\nTYPE F F F\nCOUNT 1 1 "
      "1\n"
      "WIDTH {1}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {1}\nDATA {2}\n",
      single_precision ? 4 : 8, points, data);
}

void append_uint32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xFF);
}

/// All x, then all y, then all z, compressed as one block behind its two sizes.
void write_compressed(AtomicFile& file, PointView points, bool single_precision) {
  const std::uint64_t size = std::uint64_t{points.size()} * (single_precision ? 12 : 24);
  const std::uint64_t room = size + size / 16 + 64;  // LZF grows what it cannot shrink by 1 byte in 32
  if (room > std::numeric_limits<std::uint32_t>::max()) {
    throw InvalidArgument(
        fmt::format("{} points do not fit the 4 GiB of PCD binary_compressed; write PCD binary", points.size()));
  }
  std::string columns;
  columns.reserve(size);
  for (int axis = 0; axis < 3; ++axis) {
    for (const Eigen::Vector3d& point : points) {
      append_binary(columns, point[axis], single_precision, std::endian::little);
    }
  }
  std::string compressed(room, '\0');
  const unsigned compressed_size = size == 0 ? 0
                                             : lzf_compress(columns.data(), static_cast<unsigned>(size),
                                                            compressed.data(), static_cast<unsigned>(room));
  compressed.resize(compressed_size);
  std::string sizes;
  append_uint32(sizes, compressed_size);
  append_uint32(sizes, static_cast<std::uint32_t>(size));
  file.write(sizes);
  file.write(compressed);
}

}  // namespace

void write_pcd(AtomicFile& file, PointView points, const WriteJob& job) {
  const bool single = job.single_precision;
  if (job.format == FileFormat::pcd_ascii) {
    file.write(header(points.size(), single, "ascii"));
    write_lines(file, points, single, ' ');
  } else if (job.format == FileFormat::pcd_binary) {
    file.write(header(points.size(), single, "binary"));
    write_records(file, points, single, std::endian::little);
  } else {
    file.write(header(points.size(), single, "binary_compressed"));
    write_compressed(file, points, single);
  }
}

}  // namespace igsp::io
