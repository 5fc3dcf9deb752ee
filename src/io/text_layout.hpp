#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/input_file.hpp"
#include "io/text_table.hpp"

namespace igsp::io {

/// What the first lines of a text file say about the others.
struct TextLayout {
  LineSyntax syntax;
  std::vector<Column> columns;         ///< up to the last one needed
  std::vector<std::string> names;      ///< of all columns; empty where no line names them
  std::optional<std::uint64_t> count;  ///< of points, where a line gives it (PTS)
};

/// Consumes everything before the first point. `columns` are the names or numbers (from 1) of x, y and z as the caller
/// gives them, none where they are to be found. Fails, with what would help, where they cannot be.
TextLayout read_text_layout(InputFile& file, const std::vector<std::string>& columns);

}  // namespace igsp::io
