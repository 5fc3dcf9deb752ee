#pragma once

#include "bindings.hpp"
#include "igsp/options.hpp"

namespace igsp::python {

/// Options from keywords: `preset` or `config` say where they start, the others are the command's flags without dashes
/// (--voxel-size: voxel_size). Raises TypeError that names the nearest keyword for an unknown one; throws
/// InvalidArgument and FileError.
Options options_of(const nb::dict& keywords);

/// The same options as keywords.
nb::dict keywords_of(const Options& options);

}  // namespace igsp::python
