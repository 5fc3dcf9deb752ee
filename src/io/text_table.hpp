#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "io/chunk.hpp"
#include "io/input_file.hpp"

namespace igsp::io {

/// What a value of a record is. A list is a count followed by that many values (PLY).
enum class Column : std::uint8_t { x, y, z, skip, list };

/// Points as lines of numbers, one point a line: the body of ascii PLY, ascii PCD and of text files.
struct TextTable {
  static constexpr std::uint64_t until_end = std::numeric_limits<std::uint64_t>::max();

  std::vector<Column> columns;
  std::uint64_t remaining = until_end;
  /// Text files: comments, any separator and columns after the declared ones are fine, lines after the last are not.
  bool free_form = false;

  /// A record of n values takes n digits and n separators, the very last one may lack its line end.
  void require_records(const InputFile& file) const;
  void fill(InputFile& file, Chunk& chunk);
};

/// Blank or, in text files, a comment (# or //).
bool is_ignorable(std::string_view line, bool comments);

/// The separator of this line: ';' before ',' before blanks, so that a decimal comma is an error and not a separator.
char separator_of(std::string_view line);

}  // namespace igsp::io
