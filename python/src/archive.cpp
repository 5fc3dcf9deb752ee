#include "igsp/archive.hpp"

#include <nanobind/stl/string.h>

#include "bindings.hpp"

namespace igsp::python {
namespace {

template <typename Class, void (*function)(const std::filesystem::path&, const Class&)>
void write(const std::string& path, const Class& value) {
  nb::gil_scoped_release unlocked;
  function(path, value);
}

template <typename Class, Class (*function)(const std::filesystem::path&)>
Class read(const std::string& path) {
  nb::gil_scoped_release unlocked;
  return function(path);
}

}  // namespace

void bind_archive(nb::module_& module) {
  module.def("write_features", &write<Features, write_features>, nb::arg("path"), nb::arg("features"));
  module.def("read_features", &read<Features, read_features>, nb::arg("path"));
  module.def("write_result", &write<Result, write_result>, nb::arg("path"), nb::arg("result"));
  module.def("read_result", &read<Result, read_result>, nb::arg("path"));
}

}  // namespace igsp::python
