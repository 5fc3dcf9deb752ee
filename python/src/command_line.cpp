#include "command_line.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"

namespace igsp::python {
namespace {

int run(std::vector<std::string> arguments) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  nb::gil_scoped_release unlocked;
  return cli::run(static_cast<int>(arguments.size()), pointers.data());
}

}  // namespace

void bind_command_line(nb::module_& module) {
  module.def("run_command_line", &run, nb::arg("arguments"),
             "The igsp command: the first argument is its name. Returns the exit code.");
}

}  // namespace igsp::python
