#pragma once

#include <nanobind/nanobind.h>

namespace igsp::python {

namespace nb = nanobind;

// Each adds one part of the library to the extension module.
void bind_errors(nb::module_& module);
void bind_options(nb::module_& module);
void bind_result(nb::module_& module);
void bind_features(nb::module_& module);
void bind_viewpoint(nb::module_& module);
void bind_align(nb::module_& module);
void bind_similarity(nb::module_& module);
void bind_network(nb::module_& module);
void bind_diagnosis(nb::module_& module);
void bind_evaluation(nb::module_& module);
void bind_files(nb::module_& module);
void bind_archive(nb::module_& module);
void bind_simulation(nb::module_& module);
void bind_dask_engine(nb::module_& module);
void bind_command_line(nb::module_& module);

}  // namespace igsp::python
