#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace igsp::cli {

struct CsvRecord {
  std::size_t line = 0;  ///< in the file, from 1 on
  std::vector<std::string> fields;
};

/// A comma-separated file with a header. Fields may stand in double quotes; none goes over a line end.
struct CsvTable {
  std::filesystem::path path;
  std::vector<std::string> header;
  std::vector<CsvRecord> records;  ///< every one as long as the header
};

enum class LastLine {
  any,
  ended,  ///< a last line without its line end is left out: whoever wrote it was stopped in the middle
};

/// Throws FileError with path, line and column; blank lines are skipped.
CsvTable read_csv(const std::filesystem::path& path, LastLine last_line = LastLine::any);

std::optional<std::size_t> find_column(const CsvTable& table, std::string_view name);

/// FileError: path, line, number and name of the column, what is wrong.
[[noreturn]] void fail_at(const CsvTable& table, const CsvRecord& record, std::size_t column, std::string_view what);

/// Fields with commas, in quotes where they need them; line ends inside become blanks.
std::string csv_line(const std::vector<std::string>& fields);

}  // namespace igsp::cli
