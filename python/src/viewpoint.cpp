#include "igsp/viewpoint.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>

#include "arrays.hpp"
#include "portable.hpp"

namespace igsp::python {
namespace {

ViewpointFinding find(const PointsIn& points, const std::string& name, const std::string& request,
                      const std::optional<VectorIn>& declared) {
  const ViewpointRequest parsed = parse_viewpoint(name, request);
  std::optional<Eigen::Vector3d> stated;
  if (declared) stated = vector_of(*declared);
  const PointView cloud = view_of(points);
  nb::gil_scoped_release unlocked;
  // Whoever uses such points next says what is wrong with them, and of which cloud.
  const bool usable = !cloud.empty() && std::ranges::all_of(cloud, [](const auto& point) { return point.allFinite(); });
  if (!usable) return {{}, "unknown: the points are none or not finite", ""};
  return find_viewpoint(cloud, parsed, stated);
}

}  // namespace

void bind_viewpoint(nb::module_& module) {
  portable_class<ViewpointFinding>(module, "ViewpointFinding", "A scanner's viewpoint and why it is believed.")
      .def_prop_ro(
          "viewpoint", [](const ViewpointFinding& finding) { return array_of(finding.viewpoint); },
          nb::rv_policy::automatic, "(3,) float64, in the frame of the points; None: unknown.")
      .def_ro("reason", &ViewpointFinding::reason, "Such as \"given\" or \"the file says so\".")
      .def_ro("warning", &ViewpointFinding::warning, "Why what was given is not used; mostly empty.")
      .def("__repr__",
           [](const ViewpointFinding& finding) { return fmt::format("<ViewpointFinding: {}>", finding.reason); });
  module.def("find_viewpoint", &find, nb::arg("points").noconvert(), nb::arg("name"), nb::arg("request"),
             nb::arg("declared").noconvert().none());
}

}  // namespace igsp::python
