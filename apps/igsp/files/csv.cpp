#include "files/csv.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "igsp/errors.hpp"
#include "io/input_file.hpp"

namespace igsp::cli {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::size_t line, std::string_view what) {
  throw FileError(fmt::format("{}: line {}{}", path.string(), line, what));
}

std::string quoted_field(std::string_view& rest, const std::filesystem::path& path, std::size_t line,
                         std::size_t column) {
  std::string field;
  rest.remove_prefix(1);
  while (true) {
    const std::size_t length = rest.find('"');
    if (length == std::string_view::npos) fail(path, line, fmt::format(", column {}: the quote is not closed", column));
    field += rest.substr(0, length);
    rest.remove_prefix(length + 1);
    if (!rest.starts_with('"')) break;
    field += '"';
    rest.remove_prefix(1);
  }
  if (!rest.empty() && rest[0] != ',') fail(path, line, fmt::format(", column {}: text after the quote", column));
  return field;
}

std::string plain_field(std::string_view& rest) {
  const std::size_t length = std::min(rest.find(','), rest.size());
  std::string_view field = rest.substr(0, length);
  rest.remove_prefix(length);
  while (field.ends_with(' ')) field.remove_suffix(1);
  return std::string(field);
}

std::vector<std::string> split(std::string_view rest, const std::filesystem::path& path, std::size_t line) {
  std::vector<std::string> fields;
  while (true) {
    while (rest.starts_with(' ')) rest.remove_prefix(1);
    fields.push_back(rest.starts_with('"') ? quoted_field(rest, path, line, fields.size() + 1) : plain_field(rest));
    if (rest.empty()) return fields;
    rest.remove_prefix(1);  // the comma
  }
}

void add_line(CsvTable& table, std::string_view text, std::size_t line) {
  if (text.find_first_not_of(" ,") == std::string_view::npos) return;  // blank, also as spreadsheets write it
  std::vector<std::string> fields = split(text, table.path, line);
  if (table.header.empty()) {
    table.header = std::move(fields);
    return;
  }
  if (fields.size() != table.header.size()) {
    fail(table.path, line,
         fmt::format(", column {}: the line has {} columns, the header {}",
                     std::min(fields.size(), table.header.size()) + 1, fields.size(), table.header.size()));
  }
  table.records.push_back({line, std::move(fields)});
}

}  // namespace

CsvTable read_csv(const std::filesystem::path& path, LastLine last_line) {
  CsvTable table{.path = path, .header = {}, .records = {}};
  io::InputFile file(path);
  file.detect_encoding();
  for (std::string_view text; file.read_line(text);) {
    if (file.line_end().empty() && last_line == LastLine::ended) break;
    add_line(table, text, file.line());
  }
  if (table.header.empty()) fail(path, 1, ": the file has no header");
  return table;
}

std::optional<std::size_t> find_column(const CsvTable& table, std::string_view name) {
  const auto found = std::find(table.header.begin(), table.header.end(), name);
  if (found == table.header.end()) return std::nullopt;
  return found - table.header.begin();
}

void fail_at(const CsvTable& table, const CsvRecord& record, std::size_t column, std::string_view what) {
  fail(table.path, record.line, fmt::format(", column {} ({}): {}", column + 1, table.header[column], what));
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) {
    if (&field != &fields.front()) line += ',';
    if (field.find_first_of(",\"\r\n") == std::string::npos && !field.starts_with(' ') && !field.ends_with(' ')) {
      line += field;
      continue;
    }
    line += '"';
    for (const char c : field) {
      if (c == '"') line += '"';
      line += c == '\n' || c == '\r' ? ' ' : c;
    }
    line += '"';
  }
  return line + '\n';
}

}  // namespace igsp::cli
