#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "igsp/point_cloud.hpp"
#include "io/moved_fields.hpp"
#include "io/scalar_type.hpp"
#include "io/text_table.hpp"

namespace igsp::io {

/// What of a line of numbers moves.
struct LineMotion {
  TextTable table;
  std::vector<MovedFields> moved;   ///< indices of values; a list counts as one
  std::vector<ScalarType> written;  ///< of the values; of those behind the last, and of text files, double
};

/// Appends the line with what moves written anew; all between, and what does not change, stays. Fails where the reader
/// does.
void append_moved_line(const InputFile& file, std::string_view line, const LineMotion& motion,
                       const Transformation& transformation, std::string& text);

}  // namespace igsp::io
