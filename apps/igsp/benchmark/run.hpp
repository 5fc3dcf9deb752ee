#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "benchmark/cases.hpp"
#include "benchmark/results.hpp"

namespace igsp::cli {

struct BenchmarkTask {
  BenchmarkCase one;
  std::string preset;
  std::optional<std::uint64_t> scramble_seed;
};

/// "7", or "none".
std::string scramble_text(const std::optional<std::uint64_t>& seed);

/// Reads, scrambles, aligns on the calling thread and judges. A file or a pair that makes this fail is a row with the
/// error's text. Throws Cancelled after an interrupt.
BenchmarkRow run_task(const BenchmarkTask& task);

/// From now on the peak memory of the process counts from what it holds now, where the system can do that.
void reset_peak_memory();

}  // namespace igsp::cli
