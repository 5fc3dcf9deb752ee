#pragma once

#include "bindings.hpp"
#include "files/foreign_formats.hpp"

namespace igsp::python {

/// Files that igsp.survey_formats reads and writes. `formats`, that module, must outlive them.
cli::ForeignFormats foreign_formats(nb::handle formats);

}  // namespace igsp::python
