#pragma once

#include "igsp/features.hpp"
#include "igsp/network.hpp"
#include "igsp/result.hpp"

namespace igsp::archive {

// What the library relies on in values that it did not compute itself: sizes that belong together, indices inside what
// they index, coordinates that the search structures hold. Throw Fault.
void require_consistent(const Features& features);
void require_consistent(const Result& result);
void require_consistent(const Network& network);

/// Others are only numbers.
template <typename T>
void require_consistent(const T&) {}

}  // namespace igsp::archive
