#pragma once

#include "bindings.hpp"
#include "igsp/progress.hpp"

namespace igsp::python {

/// A callback for a run without the global interpreter lock: takes the lock, lets Ctrl-C raise KeyboardInterrupt and
/// calls `function(stage, fraction)` unless that is None; False asks to stop. Whatever Python raises ends the run and
/// reaches its caller. `function` must outlive the callback.
ProgressCallback progress_of(nb::handle function);

}  // namespace igsp::python
