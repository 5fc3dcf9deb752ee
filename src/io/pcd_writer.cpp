#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstdint>
#include <string>

#include "io/pcd_compressed.hpp"
#include "io/point_writers.hpp"

namespace igsp::io {

namespace {

std::string header(const WriteJob& job, const char* data) {
  const Eigen::Vector3d position = job.viewpoint.value_or(Eigen::Vector3d::Zero());
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE {0} {0} {0}\nTYPE F F F\nCOUNT 1 1 "
      "1\n"
      "WIDTH {1}\nHEIGHT 1\nVIEWPOINT {2} 1 0 0 0\nPOINTS {1}\nDATA {3}\n",
      job.single_precision ? 4 : 8, job.count, fmt::join(position.begin(), position.end(), " "), data);
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
    file.write(header(job, "ascii"));
    write_lines(file, chunks, single, ' ');
  } else if (job.format == FileFormat::pcd_binary) {
    file.write(header(job, "binary"));
    write_records(file, chunks, single, std::endian::little);
  } else {
    file.write(header(job, "binary_compressed"));
    write_compressed(file, chunks, single);
  }
}

}  // namespace igsp::io
