#include "benchmark/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace igsp::cli {
namespace {

using Rows = std::vector<const BenchmarkRow*>;

template <typename Predicate>
std::size_t count(const Rows& rows, const Predicate& predicate) {
  return std::count_if(rows.begin(), rows.end(), [&](const BenchmarkRow* row) { return predicate(*row); });
}

std::string median_text(const Rows& rows, std::optional<double> BenchmarkRow::*field, bool of_successes) {
  std::vector<double> values;
  for (const BenchmarkRow* row : rows) {
    if (row->*field && (!of_successes || row->success == true)) values.push_back(*(row->*field));
  }
  const auto middle = median(values);
  return middle ? fmt::format("{:.3g}", *middle) : "-";
}

std::string recall_text(std::size_t said, std::size_t positives) {
  if (positives == 0) return "-";
  return fmt::format("{:.3f} ({}/{})", static_cast<double>(said) / static_cast<double>(positives), said, positives);
}

std::string line(const std::string& name, const Rows& rows) {
  const auto positive = [](const BenchmarkRow& row) { return row.truth == "known"; };
  const std::size_t said = count(rows, [&](const auto& row) { return positive(row) && row.right_and_said(); });
  return fmt::format("{:<14} {:>6} {:>6} {:>16} {:>6} {:>8} {:>7} {:>10} {:>13} {:>8}\n", name,
                     count(rows, [](const auto& row) { return row.false_accept(); }), rows.size(),
                     recall_text(said, count(rows, positive)),
                     count(rows, [&](const auto& row) { return positive(row) && row.success == true; }),
                     count(rows, [](const auto& row) { return row.verdict == "not_registered"; }),
                     count(rows, [](const auto& row) { return !row.error.empty(); }),
                     median_text(rows, &BenchmarkRow::e_r_deg, true),
                     median_text(rows, &BenchmarkRow::centroid_displacement, true),
                     median_text(rows, &BenchmarkRow::cpu_seconds, false));
}

// The distinct values of a field, in the order they first come.
std::vector<std::string> values_of(const std::vector<BenchmarkRow>& rows, std::string BenchmarkRow::*field) {
  std::vector<std::string> values;
  for (const BenchmarkRow& row : rows) {
    if (std::find(values.begin(), values.end(), row.*field) == values.end()) values.push_back(row.*field);
  }
  return values;
}

std::string preset_table(const std::vector<BenchmarkRow>& rows, const std::string& preset) {
  std::string text =
      fmt::format("preset {}\n{:<14} {:>6} {:>6} {:>16} {:>6} {:>8} {:>7} {:>10} {:>13} {:>8}\n", preset, "group",
                  "false", "cases", "recall", "right", "refused", "errors", "e_r [deg]", "displacement", "CPU [s]");
  Rows all;
  const std::vector<std::string> groups = values_of(rows, &BenchmarkRow::group);
  for (const std::string& group : groups) {
    Rows of_group;
    for (const BenchmarkRow& row : rows) {
      if (row.preset == preset && row.group == group) of_group.push_back(&row);
    }
    if (!of_group.empty()) text += line(group, of_group);
    all.insert(all.end(), of_group.begin(), of_group.end());
  }
  if (groups.size() > 1) text += line("together", all);
  return text;
}

std::string false_accepts(const std::vector<BenchmarkRow>& rows) {
  std::string text;
  std::size_t number = 0;
  for (const BenchmarkRow& row : rows) {
    if (!row.false_accept()) continue;
    ++number;
    text += fmt::format("  {} ({}), confidence {:.3f}\n", row.name, row.preset, row.confidence.value_or(0.0));
  }
  return fmt::format("false accepts: {}\n{}", number, text);
}

std::string errors(const std::vector<BenchmarkRow>& rows) {
  std::string text;
  for (const BenchmarkRow& row : rows) {
    if (!row.error.empty()) text += fmt::format("  {} ({}): {}\n", row.name, row.preset, row.error);
  }
  return text.empty() ? "" : "\nno answer\n" + text;
}

constexpr const char* legend =
    "\nfalse: wrong, yet called registered; recall: right and called registered, of the pairs with a true\n"
    "transformation; right: whatever was said; medians: e_r and the displacement of the source's centroid of the "
    "right\n"
    "ones, CPU of all\n";

}  // namespace

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

std::string summary_text(const std::vector<BenchmarkRow>& rows) {
  std::string text = false_accepts(rows);
  for (const std::string& preset : values_of(rows, &BenchmarkRow::preset))
    text += fmt::format("\n{}", preset_table(rows, preset));
  return text + errors(rows) + legend;
}

}  // namespace igsp::cli
