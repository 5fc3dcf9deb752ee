#pragma once

#include <span>

#include "matching/candidates.hpp"

namespace igsp {

/// The factor of scale that most pairs of candidates agree on.
struct RatioPeak {
  double factor = 1.0;      ///< by which the source would have to be multiplied
  double prominence = 0.0;  ///< votes above the background, in its standard deviations
};

/// Two candidates that one similarity explains have frames turned alike, and their points' difference, turned so,
/// points along the other cloud's; the ratio of both lengths then is the scale. Needs no scale to be known, only
/// descriptors that still find each other: factors between 2/3 and 3/2 are voted for. Shorter lengths than `min_length`
/// [units of the cloud] in either cloud say nothing.
RatioPeak ratio_peak(std::span<const Candidate> candidates, PointView source, PointView target, double min_length);

}  // namespace igsp
