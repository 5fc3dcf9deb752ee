#pragma once

#include "diagnosis/searched_pair.hpp"
#include "igsp/diagnosis.hpp"

namespace igsp {

/// Whether the source would register in another scale: another unit of length, or a few percent too large.
std::optional<Diagnosis> another_scale(const Scan& source, const Scan& target, const SearchedPair& pair,
                                       const Result& refused, const ProgressCallback& progress);

}  // namespace igsp
