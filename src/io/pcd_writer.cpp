#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string>

#include "io/pcd_compressed.hpp"
#include "io/point_writers.hpp"

namespace igsp::io {

namespace {

std::string header(std::uint64_t points, bool single_precision, const char* data) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE {0} {0} {0}\nTYPE F F F\nCOUNT 1 1 "
      "1\n"
      "WIDTH {1}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {1}\nDATA {2}\n",
      single_precision ? 4 : 8, points, data);
}

/// All x, then all y, then all z.
void write_compressed(AtomicFile& file, const ChunkSource& chunks, bool single_precision) {
  std::array<std::string, 3> columns;
  for (PointView chunk = chunks(); !chunk.empty(); chunk = chunks()) {
    for (const Eigen::Vector3d& point : chunk) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        append_binary(columns[axis], point[static_cast<Eigen::Index>(axis)], single_precision, std::endian::little);
      }
    }
  }
  file.write(compressed_pcd(columns[0] + columns[1] + columns[2]));
}

}  // namespace

void write_pcd(AtomicFile& file, const ChunkSource& chunks, const WriteJob& job) {
  const bool single = job.single_precision;
  if (job.format == FileFormat::pcd_ascii) {
    file.write(header(job.count, single, "ascii"));
    write_lines(file, chunks, single, ' ');
  } else if (job.format == FileFormat::pcd_binary) {
    file.write(header(job.count, single, "binary"));
    write_records(file, chunks, single, std::endian::little);
  } else {
    file.write(header(job.count, single, "binary_compressed"));
    write_compressed(file, chunks, single);
  }
}

}  // namespace igsp::io
