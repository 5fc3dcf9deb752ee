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
                      const PartsIn& declared) {
  const ViewpointRequest parsed = parse_viewpoint(name, request);
  const std::vector<ScanPart> stated = parts_of(declared);
  const PointView cloud = view_of(points);
  nb::gil_scoped_release unlocked;
  // Whoever uses such points next says what is wrong with them, and of which cloud.
  const bool usable = !cloud.empty() && std::ranges::all_of(cloud, [](const auto& point) { return point.allFinite(); });
  if (!usable) return {{}, "unknown: the points are none or not finite", ""};
  if (stated.size() > 1) return find_viewpoints(cloud, parsed, stated);
  return find_viewpoint(cloud, parsed, stated.empty() ? std::nullopt : stated.front().viewpoint);
}

}  // namespace

void bind_viewpoint(nb::module_& module) {
  portable_class<ViewpointFinding>(module, "ViewpointFinding", "A scanner's viewpoint and why it is believed.")
      .def_prop_ro(
          "viewpoint", [](const ViewpointFinding& finding) { return array_of(finding.viewpoint); },
          nb::rv_policy::automatic, "(3,) float64, in the frame of the points; None: unknown, or several.")
      .def_prop_ro(
          "parts",
          [](const ViewpointFinding& finding) {
            std::vector<std::pair<std::size_t, std::optional<Array<double, 3>>>> parts;
            for (const ScanPart& part : finding.parts) parts.emplace_back(part.points, array_of(part.viewpoint));
            return parts;
          },
          nb::rv_policy::automatic,
          "Of a cloud of several scans, for each: its number of points, and its viewpoint as above.")
      .def_ro("reason", &ViewpointFinding::reason, "Such as \"given\" or \"the file says so\".")
      .def_ro("warning", &ViewpointFinding::warning, "Why what was given is not used; mostly empty.")
      .def("__repr__",
           [](const ViewpointFinding& finding) { return fmt::format("<ViewpointFinding: {}>", finding.reason); });
  module.def("find_viewpoint", &find, nb::arg("points").noconvert(), nb::arg("name"), nb::arg("request"),
             nb::arg("declared").noconvert());
}

}  // namespace igsp::python
