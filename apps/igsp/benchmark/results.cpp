#include "benchmark/results.hpp"

#include <fmt/format.h>

#include <array>
#include <variant>

#include "igsp/errors.hpp"
#include "io/number_text.hpp"

namespace igsp::cli {
namespace {

using Row = BenchmarkRow;

struct ResultsColumn {
  const char* name;
  std::variant<std::string Row::*, std::optional<bool> Row::*, std::optional<double> Row::*> field;
};

const std::array<ResultsColumn, 24> columns = {{{"name", &Row::name},
                                                {"group", &Row::group},
                                                {"preset", &Row::preset},
                                                {"scramble", &Row::scramble},
                                                {"truth", &Row::truth},
                                                {"verdict", &Row::verdict},
                                                {"success", &Row::success},
                                                {"confidence", &Row::confidence},
                                                {"e_r_deg", &Row::e_r_deg},
                                                {"e_t", &Row::e_t},
                                                {"centroid_displacement", &Row::centroid_displacement},
                                                {"overlap", &Row::overlap},
                                                {"precision", &Row::precision},
                                                {"recall", &Row::recall},
                                                {"iterations", &Row::iterations},
                                                {"source_keypoints", &Row::source_keypoints},
                                                {"target_keypoints", &Row::target_keypoints},
                                                {"voxel_size", &Row::voxel_size},
                                                {"stage_seconds", &Row::stage_seconds},
                                                {"cpu_seconds", &Row::cpu_seconds},
                                                {"wall_seconds", &Row::wall_seconds},
                                                {"peak_memory_bytes", &Row::peak_memory_bytes},
                                                {"reason", &Row::reason},
                                                {"error", &Row::error}}};

std::string text_of(const std::string& text) {
  return text;
}
std::string text_of(const std::optional<bool>& value) {
  return !value ? "" : *value ? "yes" : "no";
}
std::string text_of(const std::optional<double>& value) {
  std::string text;
  if (value) io::append_number(text, *value);
  return text;
}

// False if the text is no such value.
bool assign(std::string& value, const std::string& text) {
  value = text;
  return true;
}
bool assign(std::optional<bool>& value, const std::string& text) {
  if (!text.empty()) value = text == "yes";
  return text.empty() || text == "yes" || text == "no";
}
bool assign(std::optional<double>& value, const std::string& text) {
  if (text.empty()) return true;
  value = io::parse_number<double>(text);
  return value.has_value();
}

}  // namespace

std::string results_header() {
  std::vector<std::string> names;
  for (const ResultsColumn& column : columns) names.push_back(column.name);
  return csv_line(names);
}

std::string results_line(const BenchmarkRow& row) {
  std::vector<std::string> fields;
  for (const ResultsColumn& column : columns) {
    fields.push_back(std::visit([&](auto member) { return text_of(row.*member); }, column.field));
  }
  return csv_line(fields);
}

std::vector<BenchmarkRow> read_results(const std::filesystem::path& path, LastLine last_line) {
  const CsvTable table = read_csv(path, last_line);
  for (const char* name : {"name", "preset", "verdict", "success"}) {
    if (find_column(table, name)) continue;
    throw FileError(
        fmt::format("{}: line 1: the column {} is missing: not the results of a benchmark", path.string(), name));
  }
  std::vector<BenchmarkRow> rows(table.records.size());
  for (const ResultsColumn& column : columns) {
    const auto position = find_column(table, column.name);
    if (!position) continue;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string& text = table.records[i].fields[*position];
      const bool fits = std::visit([&](auto member) { return assign(rows[i].*member, text); }, column.field);
      if (!fits) fail_at(table, table.records[i], *position, io::in_quotes(text) + " does not belong here");
    }
  }
  return rows;
}

}  // namespace igsp::cli
