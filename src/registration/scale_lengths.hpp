#pragma once

#include "features/scale_lengths.hpp"
#include "igsp/result.hpp"

namespace igsp {

/// The same answer in another unit of length: every length times `factor`, a power of two so that nothing is rounded.
void scale_lengths(Result& result, double factor);

}  // namespace igsp
