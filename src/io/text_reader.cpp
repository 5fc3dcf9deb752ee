#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "io/number_text.hpp"
#include "io/point_body.hpp"

namespace igsp::io {

namespace {

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> values;
  Tokenizer tokens(line, separator_of(line));
  for (std::string_view value; tokens.next(value);) values.push_back(value);
  return values;
}

/// The count of points that PTS files have on a line of its own.
std::optional<std::uint64_t> parse_count_line(const std::vector<std::string_view>& values) {
  return values.size() == 1 ? parse_number<std::uint64_t>(values[0]) : std::nullopt;
}

/// Also of a broken number: a line with '1,5' is not one of column names.
bool looks_numeric(std::string_view value) {
  return parse_number<double>(value).has_value() ||
         (!value.empty() && std::string_view("+-.0123456789").find(value[0]) != value.npos);
}

Column column_of(std::string_view name) {
  while (name.starts_with('"') || name.starts_with('\'')) name.remove_prefix(1);
  while (name.ends_with('"') || name.ends_with('\'')) name.remove_suffix(1);
  if (name == "x" || name == "X") return Column::x;
  if (name == "y" || name == "Y") return Column::y;
  if (name == "z" || name == "Z") return Column::z;
  return Column::skip;
}

/// The columns that a line of names declares, up to the last one needed.
std::vector<Column> parse_names(const InputFile& file, const std::vector<std::string_view>& names) {
  std::vector<Column> columns;
  for (const std::string_view name : names) columns.push_back(column_of(name));
  for (const Column wanted : {Column::x, Column::y, Column::z}) {
    const auto found = std::ranges::count(columns, wanted);
    if (found != 1) {
      file.fail_at_line(fmt::format("neither numbers nor column names with one '{}' (found {}): {}",
                                    "xyz"[static_cast<std::size_t>(wanted)], found, in_quotes(names[0])));
    }
  }
  while (columns.back() == Column::skip) columns.pop_back();
  return columns;
}

}  // namespace

PointBody open_text(InputFile& file) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (file.peek(3) == byte_order_mark) file.skip(3);
  TextTable table;
  table.free_form = true;
  std::optional<std::uint64_t> count;
  for (std::string_view line; file.read_line(line);) {
    if (is_ignorable(line, true)) continue;
    const auto values = split(line);
    const auto count_here = parse_count_line(values);
    if (count_here && !count) {
      count = count_here;
    } else if (std::ranges::none_of(values, looks_numeric) && table.columns.empty()) {
      table.columns = parse_names(file, values);
    } else {
      file.unread_line();
      break;
    }
  }
  if (table.columns.empty()) table.columns = {Column::x, Column::y, Column::z};
  if (count) {
    table.remaining = *count;
    table.require_records(file);
  }
  return {FileFormat::text, count.value_or(0), table};
}

}  // namespace igsp::io
