#pragma once

#include "diagnosis/searched_pair.hpp"
#include "igsp/diagnosis.hpp"

namespace igsp {

/// Whether one of the clouds is left-handed: the mirrored source would register.
std::optional<Diagnosis> mirrored(const SearchedPair& pair, const ProgressCallback& progress);

}  // namespace igsp
