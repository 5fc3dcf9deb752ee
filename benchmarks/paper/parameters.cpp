#include <fmt/format.h>

#include <array>
#include <iostream>
#include <numbers>

#include "files/output_file.hpp"
#include "staged_loop.hpp"
#include "tables.hpp"

namespace igsp::paper {
namespace {

struct Sweep {
  const char* name;
  double EnergyOptions::*field;
  double first, last, step;
};
// Of the paper's Table 1; s_ed by its numerator, the bits that one suppression radius weighs.
constexpr std::array<Sweep, 5> sweeps{{{"m", &EnergyOptions::weight_changing_rate, 2, 16, 2},
                                       {"p1", &EnergyOptions::p1, 1.5, 3.5, 0.25},
                                       {"p2", &EnergyOptions::p2, 0.5, 3.0, 0.25},
                                       {"p3", &EnergyOptions::p3, 0.75, 2.0, 0.125},
                                       {"s_ed", &EnergyOptions::distance_scale, 10, 60, 5}}};

std::string row(const Pair& pair, const StagedLoop& loop, const Sweep& sweep, double value) {
  Options options = loop.options_at_scale(paper_options());
  options.energy.*sweep.field = value;
  const LoopOutcome outcome = loop.run(options);
  MatchQuality first, last;
  if (!outcome.iterations.empty()) {
    first = quality_of(outcome.iterations.front(), loop, options, pair.truth);
    last = quality_of(outcome.iterations.back(), loop, options, pair.truth);
  }
  const PoseError error = pose_error(loop.to_world(outcome.target_from_source), pair.truth, centroid_of(pair.source));
  return fmt::format("{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:d},{:.6g}\n", pair.name, pair.dataset, sweep.name,
                     value, outcome.iterations.size(), to_string(outcome.termination), first.precision(),
                     first.recall(), last.precision(), last.recall(), outcome.has_estimate && is_right(error, pair),
                     error.rotation_rad * 180.0 / std::numbers::pi);
}

}  // namespace

void write_parameters(const std::filesystem::path& pairs, const std::filesystem::path& data) {
  cli::check_writable(data / "parameters.csv");
  std::string table =
      "pair,dataset,parameter,value,iterations,termination,first_precision,first_recall,precision,recall,right,"
      "rotation_error_deg\n";
  for (const Pair& pair : read_pairs(pairs)) {
    std::cerr << pair.name << "\n";
    const StagedLoop loop(pair, paper_options());
    for (const Sweep& sweep : sweeps) {
      for (double value = sweep.first; value < sweep.last + 0.5 * sweep.step; value += sweep.step) {
        table += row(pair, loop, sweep, value);
      }
    }
  }
  cli::write_text(data / "parameters.csv", table);
}

}  // namespace igsp::paper
