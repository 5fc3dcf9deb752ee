#include "igsp/align.hpp"

#include <nanobind/stl/optional.h>

#include "arrays.hpp"
#include "options.hpp"
#include "progress.hpp"

namespace igsp::python {
namespace {

PointView input_of(const PointsIn& points) {
  return view_of(points);
}
const Features& input_of(const Features& features) {
  return features;
}

template <typename Input>
Result run(const Input& source, const Input& target, const std::optional<MatrixIn>& initial, const Keywords& keywords,
           nb::handle progress) {
  const Options options = options_of(keywords);
  const ProgressCallback callback = progress_of(progress);
  nb::gil_scoped_release unlocked;
  if (!initial) return align(input_of(source), input_of(target), options, callback);
  return align(input_of(source), input_of(target), transformation_of(*initial), options, callback);
}

}  // namespace

void bind_align(nb::module_& module) {
  module.def("align_points", &run<PointsIn>, nb::arg("source").noconvert(), nb::arg("target").noconvert(),
             nb::arg("initial").noconvert().none(), nb::arg("options"), nb::arg("progress").none());
  module.def("align_features", &run<Features>, nb::arg("source"), nb::arg("target"),
             nb::arg("initial").noconvert().none(), nb::arg("options"), nb::arg("progress").none());
}

}  // namespace igsp::python
