#include <fmt/format.h>

#include <map>
#include <utility>

#include "benchmark/summary.hpp"

namespace igsp::cli {
namespace {

// How good an outcome is: a wrong answer called registered is worse than none.
struct Outcome {
  int rank;
  const char* words;
};

Outcome outcome_of(const BenchmarkRow& row) {
  if (!row.error.empty() || row.verdict.empty()) return {1, "no answer"};
  if (row.false_accept()) return {0, "FALSE ACCEPT"};
  if (row.truth == "none") return {4, "rightly refused"};
  if (row.right_and_said()) return {4, "right"};
  return row.success == true ? Outcome{3, "right but refused"} : Outcome{2, "refused"};
}

struct Change {
  const BenchmarkRow& before;
  const BenchmarkRow& after;
};

std::string change_line(const Change& change) {
  return fmt::format("  {} ({}): {} -> {}\n", change.after.name, change.after.preset, outcome_of(change.before).words,
                     outcome_of(change.after).words);
}

std::string verdict_line(const Change& change) {
  return fmt::format("  {} ({}): {} -> {}\n", change.after.name, change.after.preset, change.before.verdict,
                     change.after.verdict);
}

std::string section(const char* title, const std::vector<std::string>& lines) {
  return fmt::format("{}: {}\n{}", title, lines.size(), fmt::join(lines, ""));
}

// Of the rows that have the number in both, and are right in both if it is an error.
std::string ratio_line(const std::vector<Change>& pairs, const char* title, std::optional<double> BenchmarkRow::*field,
                       bool of_successes) {
  std::vector<double> ratios;
  for (const auto& [before, after] : pairs) {
    if (of_successes && !(before.success == true && after.success == true)) continue;
    if (before.*field && after.*field && *(before.*field) > 0.0) ratios.push_back(*(after.*field) / *(before.*field));
  }
  const auto middle = median(ratios);
  return middle ? fmt::format("{}: median of new / old {:.3f}, {} pairs\n", title, *middle, ratios.size()) : "";
}

}  // namespace

std::string comparison_text(const std::vector<BenchmarkRow>& before, const std::vector<BenchmarkRow>& after) {
  std::map<std::pair<std::string, std::string>, const BenchmarkRow*> old_rows;
  for (const BenchmarkRow& row : before) old_rows[{row.preset, row.name}] = &row;
  std::vector<Change> pairs;
  for (const BenchmarkRow& row : after) {
    const auto found = old_rows.find({row.preset, row.name});
    if (found != old_rows.end()) pairs.push_back({*found->second, row});
  }
  std::vector<std::string> better, worse, other;
  bool same_scramble = true;
  for (const Change& change : pairs) {
    same_scramble &= change.before.scramble == change.after.scramble;
    const int step = outcome_of(change.after).rank - outcome_of(change.before).rank;
    if (change.after.truth == "-" && change.before.verdict != change.after.verdict) {
      other.push_back(verdict_line(change));
    } else if (change.after.truth != "-" && step != 0) {
      (step > 0 ? better : worse).push_back(change_line(change));
    }
  }
  std::string text = fmt::format("compared: {} of {} rows are in both\n", pairs.size(), after.size());
  if (!same_scramble) text += "the sources were scrambled differently then\n";
  text += section("worse", worse) + section("better", better);
  if (!other.empty()) text += section("another verdict, truth unknown", other);
  text += ratio_line(pairs, "e_r", &BenchmarkRow::e_r_deg, true);
  text += ratio_line(pairs, "centroid displacement", &BenchmarkRow::centroid_displacement, true);
  return text + ratio_line(pairs, "CPU seconds", &BenchmarkRow::cpu_seconds, false);
}

}  // namespace igsp::cli
