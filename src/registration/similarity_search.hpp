#pragma once

#include "igsp/similarity.hpp"

namespace igsp {

/// Registers the source multiplied by `factor`, which may be wrong by some percent, and improves the factor from there.
SimilarityResult similarity_near(const Scan& source, const Scan& target, double factor, const Options& options,
                                 const ProgressCallback& progress);

}  // namespace igsp
