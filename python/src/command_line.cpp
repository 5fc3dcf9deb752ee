#include "command_line.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "dask_engine.hpp"
#include "foreign_formats.hpp"

namespace igsp::python {
namespace {

int run(std::vector<std::string> arguments, nb::handle formats) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  int exit_code;
  {
    nb::gil_scoped_release unlocked;
    exit_code = cli::run(static_cast<int>(arguments.size()), pointers.data(), foreign_formats(formats), dask_engine());
    cli::use_foreign_formats({});
    cli::use_dask_engine({});
  }
  if (PyErr_CheckSignals() != 0) PyErr_Clear();  // an interrupt that no Python code met: the exit code tells it
  return exit_code;
}

}  // namespace

void bind_command_line(nb::module_& module) {
  module.def("run_command_line", &run, nb::arg("arguments"), nb::arg("formats"),
             "The igsp command: the first argument is its name, `formats` are igsp.survey_formats. Returns the exit "
             "code.");
}

}  // namespace igsp::python
