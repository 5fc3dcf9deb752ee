#include "benchmark/cases.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "files/csv.hpp"
#include "igsp/errors.hpp"
#include "io/number_text.hpp"

namespace igsp::cli {
namespace {

constexpr std::array required_columns = {
    "name", "source", "target", "truth", "max_rotation_error_deg", "max_translation_error_m"};

void check_header(const CsvTable& table) {
  for (const char* name : required_columns) {
    if (find_column(table, name)) continue;
    throw FileError(fmt::format("{}: line 1: the column {} is missing; needed are {}, and group if there are several",
                                table.path.string(), name, fmt::join(required_columns, ", ")));
  }
}

class CaseReader {
 public:
  explicit CaseReader(const CsvTable& table) : table_(table), folder_(table.path.parent_path()) {}

  BenchmarkCase read(const CsvRecord& record) const {
    BenchmarkCase one;
    one.name = text(record, "name");
    one.group = find_column(table_, "group") ? text(record, "group") : "all";
    one.source = folder_ / text(record, "source");
    one.target = folder_ / text(record, "target");
    one.source_viewpoint = viewpoint(record, "source_viewpoint");
    one.target_viewpoint = viewpoint(record, "target_viewpoint");
    const std::string truth = text(record, "truth");
    one.truth = truth == "none" ? Truth::none : truth == "-" ? Truth::unknown : Truth::known;
    if (one.truth == Truth::known) {
      one.truth_file = folder_ / truth;
      one.max_rotation_error_deg = threshold(record, "max_rotation_error_deg");
      one.max_displacement = threshold(record, "max_translation_error_m");
    }
    return one;
  }

 private:
  std::string text(const CsvRecord& record, std::string_view name) const {
    const std::size_t column = *find_column(table_, name);
    if (record.fields[column].empty()) fail_at(table_, record, column, "is empty");
    return record.fields[column];
  }
  double threshold(const CsvRecord& record, std::string_view name) const {
    const std::string value = text(record, name);
    const auto number = io::parse_number<double>(value);
    if (!number || !std::isfinite(*number) || *number <= 0.0) {
      fail_at(table_, record, *find_column(table_, name), io::in_quotes(value) + " is not a number above 0");
    }
    return *number;
  }

  // "x y z" as well as what the option of igsp align takes; unknown where nothing is said.
  ViewpointRequest viewpoint(const CsvRecord& record, std::string_view name) const {
    const auto column = find_column(table_, name);
    const std::string value = column ? record.fields[*column] : "";
    if (value.empty()) return {.kind = ViewpointRequest::Kind::none};
    const auto words = io::split_words(value);
    try {
      return parse_viewpoint(name, words.size() == 3 ? fmt::format("{}", fmt::join(words, ",")) : value);
    } catch (const InvalidArgument&) {
      fail_at(table_, record, *column,
              io::in_quotes(value) + " is not a viewpoint: three finite numbers x y z, none, auto or nothing");
    }
  }

  const CsvTable& table_;
  std::filesystem::path folder_;
};

}  // namespace

std::string_view to_string(Truth truth) {
  switch (truth) {
    case Truth::known:
      return "known";
    case Truth::none:
      return "none";
    case Truth::unknown:
      break;
  }
  return "-";
}

std::vector<BenchmarkCase> read_cases(const std::filesystem::path& path) {
  const CsvTable table = read_csv(path);
  check_header(table);
  const CaseReader reader(table);
  std::vector<BenchmarkCase> cases;
  std::set<std::string> names;
  for (const CsvRecord& record : table.records) {
    cases.push_back(reader.read(record));
    if (names.insert(cases.back().name).second) continue;
    fail_at(table, record, *find_column(table, "name"), io::in_quotes(cases.back().name) + " is there already");
  }
  if (cases.empty()) throw FileError(path.string() + ": line 2: no case follows the header");
  return cases;
}

std::vector<BenchmarkCase> select_cases(const std::vector<BenchmarkCase>& cases, const std::vector<std::string>& only) {
  if (only.empty()) return cases;
  const auto matches = [](const BenchmarkCase& one, const std::string& wanted) {
    return one.group == wanted || fnmatch(wanted.c_str(), one.name.c_str(), 0) == 0;
  };
  for (const std::string& wanted : only) {
    if (std::any_of(cases.begin(), cases.end(), [&](const auto& one) { return matches(one, wanted); })) continue;
    std::set<std::string> groups;
    for (const BenchmarkCase& one : cases) groups.insert(one.group);
    throw InvalidArgument(fmt::format("--only {} selects no case; groups are {}", wanted, fmt::join(groups, ", ")));
  }
  std::vector<BenchmarkCase> selected;
  for (const BenchmarkCase& one : cases) {
    if (std::any_of(only.begin(), only.end(), [&](const auto& wanted) { return matches(one, wanted); })) {
      selected.push_back(one);
    }
  }
  return selected;
}

}  // namespace igsp::cli
