#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "benchmark/cases.hpp"

namespace igsp::cli {

/// Writes every case as it is run, for another program to answer: the moved source, the target, the truth between the
/// two, and their list, cases.csv. A case that cannot be read is named on standard error and left out. Returns the
/// number of cases written. Throws FileError if the folder cannot be written.
std::size_t export_cases(const std::vector<BenchmarkCase>& cases, const std::optional<std::uint64_t>& seed,
                         const std::filesystem::path& folder);

}  // namespace igsp::cli
