#include "igsp/align.hpp"

#include <nanobind/stl/optional.h>

#include "arrays.hpp"
#include "options.hpp"
#include "progress.hpp"

namespace igsp::python {
namespace {

template <typename Input>
Result run(const Input& source, const Input& target, const std::optional<MatrixIn>& initial, const Keywords& keywords,
           nb::handle progress) {
  const Options options = options_of(keywords);
  const ProgressCallback callback = progress_of(progress);
  nb::gil_scoped_release unlocked;
  if (!initial) return align(source, target, options, callback);
  return align(source, target, transformation_of(*initial), options, callback);
}

Result run_points(const PointsIn& source, const PointsIn& target, const PartsIn& source_parts,
                  const PartsIn& target_parts, const std::optional<MatrixIn>& initial, const Keywords& keywords,
                  nb::handle progress) {
  return run(scan_of(source, source_parts), scan_of(target, target_parts), initial, keywords, progress);
}

}  // namespace

void bind_align(nb::module_& module) {
  module.def("align_points", &run_points, nb::arg("source").noconvert(), nb::arg("target").noconvert(),
             nb::arg("source_parts").noconvert(), nb::arg("target_parts").noconvert(),
             nb::arg("initial").noconvert().none(), nb::arg("options"), nb::arg("progress").none());
  module.def("align_features", &run<Features>, nb::arg("source"), nb::arg("target"),
             nb::arg("initial").noconvert().none(), nb::arg("options"), nb::arg("progress").none());
}

}  // namespace igsp::python
