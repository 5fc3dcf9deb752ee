#pragma once

#include "igsp/result.hpp"

namespace igsp {

/// The same answer with source and target exchanged: transformations inverted, what belongs to a cloud under the other
/// one's name. The reason is left alone.
void exchange_clouds(Result& result);

}  // namespace igsp
