#include "igsp/similarity.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "options.hpp"
#include "portable.hpp"
#include "progress.hpp"

namespace igsp::python {
namespace {

SimilarityResult run(const PointsIn& source, const PointsIn& target, const PartsIn& source_parts,
                     const PartsIn& target_parts, const Keywords& keywords, nb::handle progress) {
  const Options options = options_of(keywords);
  const ProgressCallback callback = progress_of(progress);
  nb::gil_scoped_release unlocked;
  return align_similarity(scan_of(source, source_parts), scan_of(target, target_parts), options, callback);
}

}  // namespace

void bind_similarity(nb::module_& module) {
  portable_class<SimilarityResult>(module, "SimilarityResult", "A rigid motion and one factor of scale.")
      .def_ro("factor", &SimilarityResult::factor, "By which the source was multiplied.")
      .def_ro("sigma", &SimilarityResult::sigma,
              "Standard deviation of the factor, from the residuals; 0 where nothing was registered.")
      .def_ro("result", &SimilarityResult::result, "Of the source after that, in the target's unit.")
      .def_prop_ro(
          "target_from_source", [](const SimilarityResult& similarity) { return array_of(similarity.matrix()); },
          nb::rv_policy::automatic, "(4, 4) of both: p_target = target_from_source * (p_source, 1); no rigid motion.")
      .def("__bool__", [](const SimilarityResult& similarity) { return similarity.result.registered; })
      .def("__repr__", [](const SimilarityResult& similarity) {
        return fmt::format("<SimilarityResult: {}, factor {:.6g}>",
                           similarity.result.registered ? "registered" : "not registered", similarity.factor);
      });
  module.def("align_similarity", &run, nb::arg("source").noconvert(), nb::arg("target").noconvert(),
             nb::arg("source_parts").noconvert(), nb::arg("target_parts").noconvert(), nb::arg("options"),
             nb::arg("progress").none());
}

}  // namespace igsp::python
