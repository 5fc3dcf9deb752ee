#include "io/text_layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "io/column_names.hpp"
#include "io/number_text.hpp"

namespace igsp::io {

namespace {

using Axes = std::array<std::size_t, 3>;  // the columns of x, y and z, from 0
using Lines = std::vector<std::string_view>;

constexpr std::size_t sample_bytes = 65536, sample_lines = 200;

/// Also of a broken number: a line with '1,5' is not one of column names.
bool looks_numeric(std::string_view value) {
  while (value.starts_with('"') || value.starts_with('\'')) value.remove_prefix(1);
  value = value.substr(std::min(value.size(), value.find_first_not_of("[( \t")));
  return parse_number<double>(value).has_value() ||
         (!value.empty() && std::string_view("+-.0123456789").find(value[0]) != value.npos);
}

/// What was read before the first line of numbers.
struct Preamble {
  std::vector<std::string> names;            // that hold what was asked for
  std::vector<std::string> unknown_names;    // the last line that was neither
  std::vector<std::string> commented_names;  // of the last comment
  std::uint64_t unknown_line = 0;
  std::optional<std::uint64_t> count;
  bool names_at_tabs = false;
  bool data = false;  // a line of numbers follows
};

bool is_number(std::string_view text) {
  return parse_number<std::uint64_t>(text).has_value();
}

/// The columns that the caller asked for among these names; nothing if one is missing.
std::optional<Axes> find_wanted(const std::vector<std::string>& wanted, const std::vector<std::string>& names) {
  Axes axes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto same = [&](const std::string& name) {
      return name == wanted[axis] || plain_name(name) == plain_name(wanted[axis]);
    };
    const auto exact = std::ranges::find(names, wanted[axis]);
    const auto found = exact != names.end() ? exact : std::ranges::find_if(names, same);
    if (found != names.end()) {
      axes[axis] = static_cast<std::size_t>(found - names.begin());
    } else if (const auto number = parse_number<std::uint64_t>(wanted[axis]); number && *number > 0) {
      axes[axis] = *number - 1;
    } else {
      return std::nullopt;
    }
  }
  return axes;
}

std::optional<Axes> axes_of(const std::vector<std::string>& wanted, const std::vector<std::string>& names) {
  return wanted.empty() ? find_coordinates(names) : find_wanted(wanted, names);
}

/// Whether points begin here. Column names and titles begin with a word; so do the rows of chemists' files, behind a
/// count, and rows whose columns are known.
bool starts_data(std::string_view line, bool counted, bool columns_known) {
  const bool in_brackets = line.find_first_not_of(" \t") == line.find_first_of("[(");
  const auto cells = split(without_brackets(line, {.brackets = in_brackets}), separator_of(line));
  if (cells.empty()) return false;
  if (looks_numeric(cells[0])) return true;
  const auto numeric_at = [&](std::size_t i) { return i < cells.size() && looks_numeric(cells[i]); };
  if (!columns_known) return counted && numeric_at(1) && numeric_at(2) && numeric_at(3);
  return std::ranges::any_of(cells, looks_numeric);
}

void refuse_other_formats(const InputFile& file, const std::vector<std::string>& names) {
  if (plain_name(names[0]) == "ncols") {
    file.fail_at_line(
        "a grid of heights (ESRI ASCII), not points: convert it, for instance with gdal_translate -of XYZ");
  }
  if (names[0] == "OFF" || names[0] == "COFF" || names[0] == "solid") {
    file.fail_at_line("a mesh, not points: save its vertices as PLY");
  }
}

Preamble read_preamble(InputFile& file, const std::vector<std::string>& wanted) {
  Preamble preamble;
  for (std::string_view line; file.read_line(line);) {
    if (is_ignorable(line, true)) {
      const std::size_t text = line.find_first_not_of(" \t#/");
      if (text != line.npos) preamble.commented_names = names_on_line(line.substr(text));
      continue;
    }
    if (const auto count = parse_count_line(line)) {
      if (preamble.count) {
        file.fail_at_line("a second line of one number where points were expected: if this is PTX, name it .ptx");
      }
      preamble.count = count;
    } else if (starts_data(line, preamble.count.has_value(), !wanted.empty() || !preamble.names.empty())) {
      file.unread_line();
      preamble.data = true;
      return preamble;
    } else {
      const auto names = names_on_line(line);
      if (names.empty()) continue;
      refuse_other_formats(file, names);
      if (axes_of(wanted, names) && (wanted.empty() || !std::ranges::all_of(wanted, is_number))) {
        preamble.names = names;
        preamble.names_at_tabs = line.find('\t') != line.npos;
      } else if (preamble.names.empty()) {
        preamble.unknown_names = names;
        preamble.unknown_line = file.line();
      }  // else the line of units below that of the names
    }
  }
  return preamble;
}

/// The first whole lines that hold points, not consumed.
Lines sample_of(InputFile& file) {
  const std::string_view text = file.peek(sample_bytes);
  if (text.find('\0') != text.npos) {
    file.fail_at_offset(file.offset() + text.find('\0'), "a zero byte: this is a binary file, not text");
  }
  const bool whole = text.size() < sample_bytes;
  Lines lines;
  for (std::size_t begin = 0; begin < text.size() && lines.size() < sample_lines;) {
    const std::size_t end = text.find_first_of("\r\n", begin);
    if (end == text.npos && !whole && !lines.empty()) break;
    const std::string_view line = text.substr(begin, std::min(end, text.size()) - begin);
    const bool counts = !lines.empty() && parse_count_line(line);  // the next block of a PTS file
    if (!is_ignorable(line, true) && !counts) lines.push_back(line);
    begin = end == text.npos ? text.size() : end + 1;
  }
  if (whole && lines.size() > 2) lines.pop_back();  // may be cut short
  return lines;
}

/// Every x, y and z of the sample is a number, and one of them shows that its comma is a decimal mark.
bool fits(const Lines& sample, const LineSyntax& syntax, const Axes& axes, bool needs_comma) {
  bool comma = false;
  for (const std::string_view line : sample) {
    const auto cells = cells_of(line, syntax);
    for (const std::size_t axis : axes) {
      if (axis >= cells.size() || !parse_value(cells[axis], syntax)) return false;
      comma = comma || cells[axis].find(',') != cells[axis].npos;
    }
  }
  return comma || !needs_comma;
}

LineSyntax syntax_of(const Lines& sample, const Axes& axes, bool names_at_tabs) {
  const auto all = [&](auto predicate) { return std::ranges::all_of(sample, predicate); };
  const auto any = [&](auto predicate) { return std::ranges::any_of(sample, predicate); };
  const auto has = [](char c) { return [c](std::string_view line) { return line.find(c) != line.npos; }; };
  LineSyntax syntax;
  syntax.separator.reset();
  syntax.quotes = any(has('"')) || any(has('\''));
  syntax.brackets = all([](std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t");
    return first != line.npos && (line[first] == '[' || line[first] == '(');
  });
  const auto empty_between_tabs = [](std::string_view line) { return line.find("\t\t") != line.npos; };
  if (!any(has(';')) && all(has('\t')) && (names_at_tabs || any(empty_between_tabs))) syntax.separator = '\t';
  for (const char separator : {';', '\t', ',', ' '}) {  // a comma as separator: the values are in quotes
    if (syntax.separator && separator != *syntax.separator) continue;
    if (separator != ' ' && !all(has(separator))) continue;
    LineSyntax with_comma = syntax;
    with_comma.separator = separator;
    with_comma.decimal_comma = true;
    if (fits(sample, with_comma, axes, true)) return with_comma;
  }
  return syntax;
}

/// The first of four or more columns is 1, 2, 3, ...: a number of the row, and no coordinate?
bool counts_rows(const Lines& sample, const LineSyntax& syntax) {
  std::optional<std::int64_t> last;
  for (const std::string_view line : sample) {
    const auto cells = cells_of(line, syntax);
    const auto number = cells.size() < 4 ? std::nullopt : parse_number<std::int64_t>(cells[0]);
    if (!number || (last && *number != *last + 1)) return false;
    last = number;
  }
  return sample.size() >= 3;
}

bool have_decimals(const Lines& sample, const LineSyntax& syntax, const Axes& axes) {
  return std::ranges::all_of(sample, [&](std::string_view line) {
    const auto cells = cells_of(line, syntax);
    return std::ranges::all_of(axes, [&](std::size_t axis) {
      return axis < cells.size() && cells[axis].find_first_of(syntax.decimal_comma ? "," : ".eEn") != cells[axis].npos;
    });
  });
}

/// x, y and z where no name tells: the first three columns, save a label (of chemists) or a number of the row.
Axes guess_axes(const InputFile& file, const Lines& sample, const LineSyntax& syntax) {
  if (!sample.empty() && !looks_numeric(cells_of(sample[0], syntax)[0])) return {1, 2, 3};
  if (!counts_rows(sample, syntax)) return {0, 1, 2};
  if (have_decimals(sample, syntax, {1, 2, 3})) return {1, 2, 3};
  file.fail_at_line(
      file.line() + 1,
      "the first column counts 1, 2, 3, ...: is it x or the number of the row? Say which columns are x, y "
      "and z: --columns 1,2,3 or --columns 2,3,4");
}

[[noreturn]] void fail_without_columns(const InputFile& file, const Preamble& preamble,
                                       const std::vector<std::string>& wanted) {
  const auto& names = preamble.unknown_names;
  const std::uint64_t line = preamble.unknown_line;
  if (!wanted.empty()) {
    const auto missing = std::ranges::find_if(wanted, [&](const std::string& name) {
      return !is_number(name) && !find_wanted({name, name, name}, names);
    });
    const std::string_view name = missing == wanted.end() ? wanted[0] : *missing;
    if (names.empty()) {
      file.fail(
          fmt::format("--columns {}: no line of the file names its columns; give numbers, such as --columns 1,2,3",
                      fmt::join(wanted, ",")));
    }
    file.fail_at_line(line,
                      fmt::format("no column named {}; the file has {}", in_quotes(name), fmt::join(names, ", ")));
  }
  if (are_geographic(names)) {
    file.fail_at_line(line, fmt::format("columns {}: degrees are no lengths; project the points to metres (UTM) first",
                                        fmt::join(names, ", ")));
  }
  for (const std::string_view name : {"x", "y", "z"}) {
    const auto same = [&](const std::string& other) { return plain_name(other) == name; };
    const auto found = std::ranges::count_if(names, same);
    if (found < 2) continue;
    file.fail_at_line(
        line,
        fmt::format("{} columns named {}; say which, by their numbers from 1, such as --columns 1,2,3", found, name));
  }
  const std::size_t first = names.size() >= 4 && plain_name(names[0]).find("id") != std::string::npos ? 1 : 0;
  file.fail_at_line(
      line,
      fmt::format("no column named x; the file has {}: --columns {}", fmt::join(names, ", "),
                  fmt::join(names.begin() + static_cast<std::ptrdiff_t>(first),
                            names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), first + 3)), ",")));
}

/// Whether the line above the points names columns, none of which is x: it is no title and no chemist's remark.
bool names_columns(const InputFile& file, const Preamble& preamble, const Lines& sample) {
  const auto& names = preamble.unknown_names;
  if (names.empty()) return false;
  if (!preamble.data) {
    if (names.size() >= 3) return true;
    file.fail_at_line(preamble.unknown_line, "neither numbers nor column names: " + in_quotes(names[0]));
  }
  if (names.size() < 3 || preamble.unknown_line != file.line()) return false;
  const auto cells = split(sample[0], separator_of(sample[0]));
  return !preamble.count || (cells.size() == names.size() && looks_numeric(cells[0]));
}

std::vector<Column> columns_at(const Axes& axes) {
  std::vector<Column> columns(*std::ranges::max_element(axes) + 1, Column::skip);
  for (std::size_t axis = 0; axis < 3; ++axis) columns[axes[axis]] = static_cast<Column>(axis);
  return columns;
}

/// Half as many names as values: the commas between the values are decimal marks as well.
void refuse_doubled_columns(const InputFile& file, const TextLayout& layout, const Lines& sample) {
  const auto doubled = [&](std::string_view line) {
    return separator_of(line) == ',' && cells_of(line, layout.syntax).size() == 2 * layout.names.size();
  };
  if (layout.names.empty() || sample.empty() || !std::ranges::all_of(sample, doubled)) return;
  file.fail_at_line(file.line() + 1,
                    fmt::format("{} values under {} names: commas are both decimal marks and separators; "
                                "export with ';' or with decimal points",
                                2 * layout.names.size(), layout.names.size()));
}

}  // namespace

TextLayout read_text_layout(InputFile& file, const std::vector<std::string>& wanted) {
  const Preamble preamble = read_preamble(file, wanted);
  const Lines sample = preamble.data ? sample_of(file) : Lines{};
  TextLayout layout;
  layout.count = preamble.count;
  layout.names = preamble.names;
  std::optional<Axes> axes = preamble.names.empty() ? std::nullopt : axes_of(wanted, preamble.names);
  if (!axes && !wanted.empty()) axes = find_wanted(wanted, preamble.commented_names);
  if (!axes && (!wanted.empty() || names_columns(file, preamble, sample))) {
    fail_without_columns(file, preamble, wanted);
  }
  layout.syntax = syntax_of(sample, axes.value_or(Axes{0, 1, 2}), preamble.names_at_tabs);
  if (!axes) {  // names in a comment are believed where the rows have as many values
    const auto commented = find_coordinates(preamble.commented_names);
    const bool as_many =
        !sample.empty() && cells_of(sample[0], layout.syntax).size() == preamble.commented_names.size();
    if (commented && as_many) {
      axes = commented;
      layout.names = preamble.commented_names;
    }
  }
  if (!axes) axes = guess_axes(file, sample, layout.syntax);
  refuse_doubled_columns(file, layout, sample);
  layout.columns = columns_at(*axes);
  return layout;
}

}  // namespace igsp::io
