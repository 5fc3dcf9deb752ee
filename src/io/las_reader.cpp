#include <algorithm>

#include "io/point_body.hpp"

namespace igsp::io {

PointBody open_las(InputFile& file, bool keep_noise) {
  LasRecords records{read_las_header(file), keep_noise};
  const std::uint64_t count = records.header.count;
  return {FileFormat::las, count, {}, std::move(records)};
}

void LasRecords::fill(InputFile& file, Chunk& chunk) {
  const std::size_t stride = header.record_length;
  const std::uint64_t block = InputFile::buffer_size / stride;
  while (!chunk.full() && header.count > 0) {
    const std::uint64_t now = std::min({block, header.count, std::uint64_t{chunk.limit - chunk.points.size()}});
    const char* record = file.read(now * stride).data();
    for (std::uint64_t i = 0; i < now; ++i, record += stride) {
      if (!keep_noise && header.is_noise(record)) {
        ++chunk.noise;
      } else {
        chunk.points.push_back(header.position(record));
      }
    }
    header.count -= now;
  }
}

}  // namespace igsp::io
