#include <fmt/format.h>

#include "io/point_writers.hpp"

namespace igsp::io {

/// CSV begins with the names of its columns, PTS with the number of its points; the others are numbers only,
/// save that no file is left without a byte: 0 points must not look like a lost file.
void write_text(AtomicFile& file, const ChunkSource& chunks, const WriteJob& job) {
  const bool csv = job.extension == ".csv";
  if (csv) file.write("x,y,z\n");
  if (job.extension == ".pts") file.write(fmt::format("{}\n", job.count));
  if (job.count == 0) file.write("# 0 points\n");
  write_lines(file, chunks, job.single_precision, csv ? ',' : ' ');
}

}  // namespace igsp::io
