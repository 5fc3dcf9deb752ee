#include "io/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/number_text.hpp"

namespace igsp::io {

namespace {

[[noreturn]] void fail_too_few(const InputFile& file, std::size_t found, const TextTable& table) {
  file.fail_at_line(
      fmt::format("too few numbers: {} where at least {} are needed for a point{}", found, table.columns.size(),
                  file.remaining() == 0 ? "; it is the last line: the file was cut short, delete the line "
                                          "or copy the file again"
                                        : ""));
}

[[noreturn]] void fail_not_a_number(const InputFile& file, std::string_view token, std::string_view line,
                                    const TextTable& table) {
  const bool comma = line.find(',') != line.npos && separator_of(line) != ';';
  file.fail_at_line(fmt::format("{} is not a number (or too large or too small for one){}", in_quotes(token),
                                !comma            ? ""
                                : table.free_form ? "; its comma: values are told apart by ';', tabs or blanks where "
                                                    "the comma is the decimal mark"
                                                  : "; its comma: this format puts blanks between values and writes "
                                                    "1.5, replace the commas"));
}

void skip_list(const InputFile& file, Tokenizer& tokens, std::string_view count_token) {
  const auto count = parse_number<std::uint64_t>(count_token);
  if (!count) file.fail_at_line(in_quotes(count_token) + " is not the length of a list");
  std::string_view token;
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (!tokens.next(token)) file.fail_at_line(fmt::format("a list of {} values ends after {}", *count, i));
  }
}

std::optional<double> parse_decimal_comma(std::string_view token) {
  std::array<char, 64> digits;
  const bool at_the_rim = token.starts_with(',') || token.ends_with(',');
  if (token.size() > digits.size() || at_the_rim || token.find('.') != token.npos) return std::nullopt;
  std::ranges::replace_copy(token, digits.begin(), ',', '.');
  return parse_number<double>({digits.data(), token.size()});
}

}  // namespace

Column coordinate_named(std::string_view name) {
  if (name == "x" || name == "X") return Column::x;
  if (name == "y" || name == "Y") return Column::y;
  if (name == "z" || name == "Z") return Column::z;
  return Column::skip;
}

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

std::string_view without_brackets(std::string_view line, const LineSyntax& syntax) {
  if (!syntax.brackets) return line;
  const std::size_t first = line.find_first_not_of(" \t[(");
  if (first == line.npos) return {};
  return line.substr(first, line.find_last_not_of(" \t]),") + 1 - first);
}

std::vector<std::string_view> cells_of(std::string_view line, const LineSyntax& syntax) {
  line = without_brackets(line, syntax);
  return split(line, syntax.separator ? *syntax.separator : separator_of(line));
}

std::optional<double> parse_value(std::string_view token, const LineSyntax& syntax) {
  if (syntax.quotes) {
    while (token.starts_with('"') || token.starts_with('\'')) token.remove_prefix(1);
    while (token.ends_with('"') || token.ends_with('\'')) token.remove_suffix(1);
  }
  return syntax.decimal_comma ? parse_decimal_comma(token) : parse_number<double>(token);
}

std::optional<std::uint64_t> parse_count_line(std::string_view line) {
  const auto words = split_words(line);
  return words.size() == 1 ? parse_number<std::uint64_t>(words[0]) : std::nullopt;
}

std::array<double, 3> parse_point(const InputFile& file, std::string_view line, const TextTable& table) {
  line = without_brackets(line, table.syntax);
  Tokenizer tokens(line, table.syntax.separator ? *table.syntax.separator : separator_of(line));
  std::array<double, 3> point{};
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
    const auto value = parse_value(token, table.syntax);
    if (!value) fail_not_a_number(file, token, line, table);
    point[static_cast<std::size_t>(column)] = *value;
  }
  if (!table.free_form && tokens.next(token)) {
    file.fail_at_line(fmt::format("more values than the {} that the header declares", table.columns.size()));
  }
  return point;
}

void TextTable::require_records(const InputFile& file) const {
  const std::uint64_t bytes = 2 * columns.size();
  if (remaining > 0 && (file.remaining() + 1) / bytes < remaining) file.require_records(remaining, bytes, "points");
}

bool TextTable::next_line(InputFile& file, std::string_view& line,
                          const std::function<void(std::string_view)>& passed) {
  while (remaining > 0 || free_form) {
    if (!file.read_line(line)) {
      if (remaining == until_end || remaining == 0) return false;
      file.fail_at_line(
          fmt::format("the file ends here, {} points too early: truncated, or the count at its top is "
                      "wrong",
                      remaining));
    }
    if (is_ignorable(line, free_form)) {
      if (passed) passed(line);
      continue;
    }
    if (remaining == until_end) return true;
    if (remaining > 0) {
      --remaining;
      return true;
    }
    const auto next_block = parse_count_line(line);
    if (!next_block) {
      file.fail_at_line(
          "more points than the count at the top declares: correct that count, or delete it to read all lines");
    }
    remaining = *next_block;
    require_records(file);
    if (passed) passed(line);
  }
  return false;
}

void TextTable::fill(InputFile& file, Chunk& chunk) {
  for (std::string_view line; !chunk.full() && next_line(file, line);) {
    const auto [x, y, z] = parse_point(file, line, *this);
    chunk.add(x, y, z);
  }
}

}  // namespace igsp::io
