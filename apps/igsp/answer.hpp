#pragma once

#include <string>

#include "igsp/result.hpp"

namespace igsp::cli {

/// Four lines; the numbers read back as the same doubles.
std::string matrix_text(const Transformation& transformation);

/// What `igsp align` prints: verdict, transformation and the evidence. `seconds` is the time of the whole run;
/// `verbose` adds a line per iteration and per stage.
std::string answer_text(const Result& result, double seconds, bool verbose);

}  // namespace igsp::cli
