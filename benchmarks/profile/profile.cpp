// What callgrind counts for docs/profile.md: the stages of `align` on a fixed set of simulated pairs, in one thread,
// and three kernels beside loops that do no more than they must. Run by scripts/instructions.py; without callgrind it counts
// nothing. Prints what was worked on, `name value` a line.

#include <fmt/format.h>
#include <valgrind/callgrind.h>

#include <string>

#include "igsp/igsp.hpp"
#include "profile/limits.hpp"

namespace {

using igsp::Points;

/// What was counted since the last call belongs to this name.
void counted(const std::string& name) {
  CALLGRIND_DUMP_STATS_AT(name.c_str());
}

Points scan_of(const char* scene, int points, std::size_t station) {
  return igsp::simulate(scene, {.points = points})[station].points;
}

igsp::Options one_thread() {
  igsp::Options options;
  options.threads = 1;
  return options;
}

void count_stages(const std::string& pair, const Points& source, const Points& target) {
  const igsp::ProgressCallback at_the_end_of_each = [&](const igsp::Progress& progress) {
    if (progress.fraction == 1.0) counted(fmt::format("{}/{}", pair, progress.stage));
    return true;
  };
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
  const igsp::Result result = igsp::align(source, target, one_thread(), at_the_end_of_each);
  counted(pair + "/rest");
  CALLGRIND_STOP_INSTRUMENTATION;
  fmt::print("{}/registered {}\n", pair, result.registered ? 1 : 0);
}

void count_kernels(const Points& source, const Points& target) {
  const igsp::profile::Kernels kernels(source, target, one_thread());
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
  for (const igsp::profile::Kernel& kernel : kernels.all()) {
    kernel.run();
    counted("kernel/" + kernel.name);
    kernel.least();
    counted("least/" + kernel.name);
    fmt::print("work/{} {}\n", kernel.name, kernel.work);
  }
  CALLGRIND_STOP_INSTRUMENTATION;
  fmt::print("vectors {}\n", kernels.vectors());
}

}  // namespace

int main() {
  const Points park_source = scan_of("park", 20'000, 1), park_target = scan_of("park", 20'000, 0);
  const Points indoor_source = scan_of("indoor", 30'000, 1), indoor_target = scan_of("indoor", 30'000, 0);
  count_stages("park", park_source, park_target);
  count_stages("indoor", indoor_source, indoor_target);
  count_stages("without overlap", park_source, indoor_target);
  count_kernels(park_source, park_target);
}
