#pragma once

#include "bindings.hpp"
#include "igsp/options.hpp"

namespace igsp::python {

/// Keywords of Python with their values.
using Keywords = nb::typed<nb::dict, nb::str, nb::any>;

/// Options from keywords: `preset` or `config` say where they start, the others are the command's flags without dashes
/// (--voxel-size: voxel_size). Raises TypeError that names the nearest keyword for an unknown one; throws
/// InvalidArgument and FileError.
Options options_of(const Keywords& keywords);

/// The same options as keywords.
Keywords keywords_of(const Options& options);

}  // namespace igsp::python
