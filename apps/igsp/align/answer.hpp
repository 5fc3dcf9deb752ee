#pragma once

#include <string>
#include <vector>

#include "igsp/diagnosis.hpp"
#include "igsp/result.hpp"

namespace igsp::cli {

/// Four lines in aligned columns; the numbers read back as the same doubles.
std::string matrix_text(const Transformation& transformation);

/// The same motion of a cloud that is multiplied by `scale` first, in one matrix; no rigid motion unless that is 1.
Transformation with_scale(Transformation target_from_source, double scale);

/// What `igsp align` prints: verdict and its causes, transformation and the evidence. `scale` is what the source was
/// multiplied by, `seconds` the time of the whole run.
std::string answer_text(const Result& result, double scale, const std::vector<Diagnosis>& diagnosis,
                        bool voxel_size_given, double seconds);

/// Such as "1 of 8254 points lies 2.3 extents away and was left out".
std::string stray_text(const CloudSummary& cloud);

/// What `--verbose` adds: a line per iteration and per stage.
std::string details_text(const Result& result);

}  // namespace igsp::cli
