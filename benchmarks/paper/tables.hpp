#pragma once

#include <filesystem>

namespace igsp::paper {

// Each writes CSV of its raw figures for the pairs that `igsp_paper pairs` wrote into `pairs`; CPU seconds, one thread.

/// registrations.csv, a row per pair and preset (Tables 3 and 4); iterations.csv, a row per iteration (Fig. 4 and 8,
/// the cost of both assignments).
void write_registrations(const std::filesystem::path& pairs, const std::filesystem::path& data);

/// parameters.csv: the paper's preset with one of m, p1, p2, p3, s_ed changed (Fig. 3).
void write_parameters(const std::filesystem::path& pairs, const std::filesystem::path& data);

/// growth.csv: an iteration's cost over the number of keypoints, on a simulated park.
void write_growth(const std::filesystem::path& data);

}  // namespace igsp::paper
