#include "io/text_table.hpp"

#include <fmt/format.h>

#include <array>

#include "io/number_text.hpp"

namespace igsp::io {

namespace {

using Coordinates = std::array<double, 3>;

[[noreturn]] void fail_too_few(const InputFile& file, std::size_t found, const TextTable& table) {
  file.fail_at_line(
      fmt::format("too few numbers: {} where at least {} are needed for a point", found, table.columns.size()));
}

void skip_list(const InputFile& file, Tokenizer& tokens, std::string_view count_token) {
  const auto count = parse_number<std::uint64_t>(count_token);
  if (!count) file.fail_at_line(in_quotes(count_token) + " is not the length of a list");
  std::string_view token;
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (!tokens.next(token)) file.fail_at_line(fmt::format("a list of {} values ends after {}", *count, i));
  }
}

Coordinates parse_point(const InputFile& file, std::string_view line, const TextTable& table) {
  Tokenizer tokens(line, table.free_form ? separator_of(line) : ' ');
  Coordinates point{};
  std::string_view token;
  std::size_t found = 0;
  for (const Column column : table.columns) {
    if (!tokens.next(token)) fail_too_few(file, found, table);
    ++found;
    if (column == Column::skip) continue;
    if (column == Column::list) {
      skip_list(file, tokens, token);
      continue;
    }
    const auto value = parse_number<double>(token);
    if (!value) file.fail_at_line(in_quotes(token) + " is not a number (or too large or too small for one)");
    point[static_cast<std::size_t>(column)] = *value;
  }
  if (!table.free_form && tokens.next(token)) {
    file.fail_at_line(fmt::format("more values than the {} that the header declares", table.columns.size()));
  }
  return point;
}

void expect_no_more_points(InputFile& file) {
  for (std::string_view line; file.read_line(line);) {
    if (!is_ignorable(line, true)) file.fail_at_line("more points than the count at the top of the file declares");
  }
}

}  // namespace

bool is_ignorable(std::string_view line, bool comments) {
  while (!line.empty() && Tokenizer::is_blank(line.front())) line.remove_prefix(1);
  return line.empty() || (comments && (line.starts_with('#') || line.starts_with("//")));
}

char separator_of(std::string_view line) {
  for (const char separator : {';', ','}) {
    if (line.find(separator) != line.npos) return separator;
  }
  return ' ';
}

void TextTable::require_records(const InputFile& file) const {
  const std::uint64_t bytes = 2 * columns.size();
  if (remaining > 0 && (file.remaining() + 1) / bytes < remaining) file.require_records(remaining, bytes, "points");
}

void TextTable::fill(InputFile& file, Chunk& chunk) {
  if (remaining == 0) return;
  while (!chunk.full() && remaining > 0) {
    std::string_view line;
    if (!file.read_line(line)) {
      if (remaining == until_end) return;
      file.fail_at_line(fmt::format("the file ends here, {} points too early: truncated", remaining));
    }
    if (is_ignorable(line, free_form)) continue;
    const auto [x, y, z] = parse_point(file, line, *this);
    chunk.add(x, y, z);
    if (remaining != until_end) --remaining;
  }
  if (remaining == 0 && free_form) expect_no_more_points(file);
}

}  // namespace igsp::io
