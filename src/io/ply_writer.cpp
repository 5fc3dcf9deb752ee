#include <fmt/format.h>

#include "io/ply_header.hpp"
#include "io/point_writers.hpp"

namespace igsp::io {

void write_ply(AtomicFile& file, const ChunkSource& chunks, const WriteJob& job) {
  const bool ascii = job.format == FileFormat::ply_ascii;
  const bool big = job.format == FileFormat::ply_binary_big_endian;
  const char* type = job.single_precision ? "float" : "double";
  file.write(fmt::format("ply\nformat {} 1.0\n{}element vertex {}\n",
                         ascii ? "ascii"
                         : big ? "binary_big_endian"
                               : "binary_little_endian",
                         job.viewpoint ? ply_viewpoint_comment(*job.viewpoint) + "\n" : "", job.count));
  file.write(fmt::format("property {0} x\nproperty {0} y\nproperty {0} z\nend_header\n", type));
  if (ascii) {
    write_lines(file, chunks, job.single_precision, ' ');
  } else {
    write_records(file, chunks, job.single_precision, big ? std::endian::big : std::endian::little);
  }
}

}  // namespace igsp::io
