#include "progress.hpp"

namespace igsp::python {

ProgressCallback progress_of(nb::handle function) {
  return [function](const Progress& progress) {
    nb::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (function.is_none()) return true;
    const nb::object answer = function(nb::str(progress.stage.data(), progress.stage.size()), progress.fraction);
    return !answer.is(nb::handle(Py_False));
  };
}

}  // namespace igsp::python
