#pragma once

#include "igsp/features.hpp"

namespace igsp {

/// The same features in another unit of length: every length times `factor`, a power of two so that nothing is rounded.
void scale_lengths(Features& features, double factor);

}  // namespace igsp
