#include "igsp/errors.hpp"

#include "bindings.hpp"

namespace igsp::python {
namespace {

// InvalidArgument needs nothing: it is a std::invalid_argument, which is a ValueError already.
void translate_file_error(const std::exception_ptr& pointer, void*) {
  try {
    std::rethrow_exception(pointer);
  } catch (const FileError& error) {
    PyErr_SetString(PyExc_OSError, error.what());
  }
}

}  // namespace

void bind_errors(nb::module_& module) {
  nb::register_exception_translator(translate_file_error);
  nb::exception<Cancelled>(module, "Cancelled", PyExc_RuntimeError).attr("__doc__") =
      "A progress function returned False: it asked to stop.";
}

}  // namespace igsp::python
