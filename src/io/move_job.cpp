#include "io/move_job.hpp"

#include <algorithm>

#include "core/report_progress.hpp"

namespace igsp::io {

void MoveJob::flush_if_full() {
  constexpr std::size_t full = std::size_t{1} << 18;
  if (bytes.size() >= full) flush();
}

void MoveJob::flush() {
  destination_.write(bytes);
  bytes.clear();
  report_progress(progress_, "write", file.offset(), file.size());
}

void MoveJob::copy_lines_read(const std::function<std::string(std::string_view line)>& edited) {
  InputFile again(file.path());
  again.detect_encoding();
  for (std::string_view line; again.line() < file.line() && again.read_line(line);) {
    bytes += edited(line);
    bytes += again.line_end();
  }
}

void MoveJob::copy(std::uint64_t count) {
  while (count > 0) {
    const std::uint64_t now = std::min<std::uint64_t>(count, InputFile::buffer_size);
    bytes += file.read(now);
    count -= now;
    flush_if_full();
  }
}

void MoveJob::copy_rest() {
  for (std::string_view some = file.peek(InputFile::buffer_size); !some.empty();
       some = file.peek(InputFile::buffer_size)) {
    bytes += file.read(some.size());
    flush_if_full();
  }
}

}  // namespace igsp::io
