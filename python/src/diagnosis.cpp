#include "igsp/diagnosis.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "portable.hpp"
#include "progress.hpp"

namespace igsp::python {
namespace {

std::vector<Diagnosis> run(const PointsIn& source, const PointsIn& target, const PartsIn& source_parts,
                           const PartsIn& target_parts, const Result& refused, bool search, nb::handle progress) {
  const ProgressCallback callback = progress_of(progress);
  nb::gil_scoped_release unlocked;
  return diagnose(scan_of(source, source_parts), scan_of(target, target_parts), refused, {.search = search}, callback);
}

std::optional<Array<double, 4, 4>> matrix_of(const Diagnosis& diagnosis) {
  if (!diagnosis.target_from_source) return std::nullopt;
  return array_of(*diagnosis.target_from_source);
}

}  // namespace

void bind_diagnosis(nb::module_& module) {
  portable_class<Diagnosis>(module, "Diagnosis", "What about the clouds stands in the way of a registration.")
      .def_prop_ro(
          "cause", [](const Diagnosis& diagnosis) { return to_string(diagnosis.cause); },
          "too_few_points, flat, degrees, coarse_coordinates or mirrored.")
      .def_ro("description", &Diagnosis::description, "One sentence: the cause, how it was seen, the remedy.")
      .def_prop_ro("target_from_source", &matrix_of, nb::rv_policy::automatic,
                   "(4, 4) float64: what would register, with a reflection where mirrored; None: not looked for.")
      .def("__str__", [](const Diagnosis& diagnosis) { return diagnosis.description; })
      .def("__repr__",
           [](const Diagnosis& diagnosis) { return fmt::format("<Diagnosis: {}>", to_string(diagnosis.cause)); });
  module.def("diagnose", &run, nb::arg("source").noconvert(), nb::arg("target").noconvert(),
             nb::arg("source_parts").noconvert(), nb::arg("target_parts").noconvert(), nb::arg("refused"),
             nb::arg("search"), nb::arg("progress").none());
}

}  // namespace igsp::python
