#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "io/chunk.hpp"
#include "io/input_file.hpp"

namespace igsp::io {

/// What a value of a record is. A list is a count followed by that many values (PLY).
enum class Column : std::uint8_t { x, y, z, skip, list };

/// x, y or z by its name in a PLY or PCD header, also as a capital letter.
Column coordinate_named(std::string_view name);

/// How a line is cut into values and a value is read. The default is that of PLY and PCD.
struct LineSyntax {
  std::optional<char> separator = ' ';  ///< ' ' any run of blanks; none: every line decides, see separator_of
  bool decimal_comma = false;
  bool brackets = false;  ///< around every line
  bool quotes = false;    ///< around a value
};

/// Points as lines of numbers, one point a line: the body of ascii PLY, ascii PCD and of text files.
struct TextTable {
  static constexpr std::uint64_t until_end = std::numeric_limits<std::uint64_t>::max();

  std::vector<Column> columns;
  std::uint64_t remaining = until_end;
  /// Text files: comments and columns after the declared ones are fine; behind counted lines may follow a further count
  /// and its lines (PTS).
  bool free_form = false;
  LineSyntax syntax = {};

  /// A record of n values takes n digits and n separators, the very last one may lack its line end.
  void require_records(const InputFile& file) const;
  /// The next line that holds a point; false at the end. Takes the counts on the way and shows `passed`, if there is
  /// one, the lines without a point.
  bool next_line(InputFile& file, std::string_view& line, const std::function<void(std::string_view)>& passed = {});
  void fill(InputFile& file, Chunk& chunk);
};

/// Blank or, in text files, a comment (# or //).
bool is_ignorable(std::string_view line, bool comments);

/// The separator of this line: ';' before ',' before blanks.
char separator_of(std::string_view line);

/// The line without what stands around its values.
std::string_view without_brackets(std::string_view line, const LineSyntax& syntax);

/// The values of the line, as they stand there.
std::vector<std::string_view> cells_of(std::string_view line, const LineSyntax& syntax);

/// A value as a number, with a decimal comma and in quotes where the syntax says so.
std::optional<double> parse_value(std::string_view token, const LineSyntax& syntax);

/// A count of points on a line of its own (PTS).
std::optional<std::uint64_t> parse_count_line(std::string_view line);

/// x, y and z of a line. Fails where there are none.
std::array<double, 3> parse_point(const InputFile& file, std::string_view line, const TextTable& table);

}  // namespace igsp::io
