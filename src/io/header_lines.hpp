#pragma once

#include <string_view>

#include "io/input_file.hpp"

namespace igsp::io {

/// The next line of a PLY or PCD header; fails where the file ends or the header grows beyond `longest_header`.
inline std::string_view read_header_line(InputFile& file) {
  constexpr std::uint64_t longest_header = std::uint64_t{1} << 20;
  std::string_view line;
  if (!file.read_line(line)) file.fail_at_line("the file ends inside the header: truncated");
  if (file.offset() > longest_header + line.size()) file.fail_at_line("no end of the header within its first 1 MiB");
  return line;
}

}  // namespace igsp::io
