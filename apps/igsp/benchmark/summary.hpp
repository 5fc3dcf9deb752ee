#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/results.hpp"

namespace igsp::cli {

/// Median, the mean of both middle values of an even number; nothing of nothing.
std::optional<double> median(std::vector<double> values);

/// A table per preset with a line per group, in the order they first come: false accepts first.
std::string summary_text(const std::vector<BenchmarkRow>& rows);

/// What got better and what got worse since `before`, of the cases and presets that both have.
std::string comparison_text(const std::vector<BenchmarkRow>& before, const std::vector<BenchmarkRow>& after);

}  // namespace igsp::cli
