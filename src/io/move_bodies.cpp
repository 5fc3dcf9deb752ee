#include "io/move_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace igsp::io {

void move_lines(MoveJob& job, LineMotion motion) {
  if (motion.table.remaining != TextTable::until_end) motion.table.require_records(job.file);
  const auto passed = [&](std::string_view blank) {
    job.bytes += blank;
    job.bytes += job.file.line_end();
  };
  for (std::string_view line; motion.table.next_line(job.file, line, passed);) {
    append_moved_line(job.file, line, motion, job.transformation, job.bytes);
    job.bytes += job.file.line_end();
    job.flush_if_full();
  }
}

void move_fixed_records(MoveJob& job, std::uint64_t count, const FixedMotion& motion) {
  if (motion.read_size() == 0) return;
  job.file.require_records(count, motion.read_size(), "records");
  if (motion.read_size() > InputFile::buffer_size) {
    job.file.fail_at_offset(job.file.offset(), fmt::format("{} bytes for one record; at most {} are supported",
                                                           motion.read_size(), InputFile::buffer_size));
  }
  for (const std::uint64_t block = InputFile::buffer_size / motion.read_size(); count > 0;) {
    const std::uint64_t now = std::min(block, count);
    motion.append(job.file, job.file.read(now * motion.read_size()).data(), now, job.transformation, job.bytes);
    job.flush_if_full();
    count -= now;
  }
}

}  // namespace igsp::io
