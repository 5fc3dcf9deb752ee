#include "igsp/simulation.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "portable.hpp"

namespace igsp::python {
namespace {

constexpr const char* docstring = R"(Scans of a made-up scene with their true relation, by ray casting.

`scene` is "park" or "indoor", seen by a levelled terrestrial scanner of unknown yaw, or "object", 0.2 m large, seen by
a range camera in any pose. `points` is about what a station gets, `noise` the standard deviation along the ray [m]
(None: the scene's own), `station_distance` that between neighbouring stations [m] (0: the scene's own). Every `seed` is
another scene; the same arguments give the same scans. Raises ValueError.)";

}  // namespace

void bind_simulation(nb::module_& module) {
  portable_class<SimulatedScan>(module, "SimulatedScan",
                                "One scan in the scanner's own frame, its origin is the sensor.")
      .def_prop_ro(
          "points", [](SimulatedScan& scan) { return view(scan.points); }, "(N, 3) float64 [m].")
      .def_prop_ro(
          "world_from_scanner", [](const SimulatedScan& scan) { return array_of(scan.world_from_scanner); },
          nb::rv_policy::automatic, "(4, 4) float64: where the scanner stood.")
      .def_prop_ro(
          "viewpoint", [](const SimulatedScan& scan) { return array_of(scan.viewpoint); }, nb::rv_policy::automatic,
          "(3,) float64: where the sensor was in the frame of the points; None where they lie on no surface.")
      .def("__repr__",
           [](const SimulatedScan& scan) { return fmt::format("<SimulatedScan: {} points>", scan.points.size()); });
  const SimulationOptions defaults;
  module.def(
      "simulate",
      [](const std::string& scene, int stations, int points, std::optional<double> noise, double station_distance,
         std::uint64_t seed) {
        nb::gil_scoped_release unlocked;
        return simulate(scene, {.stations = stations,
                                .points = points,
                                .noise = noise,
                                .station_distance = station_distance,
                                .seed = seed});
      },
      nb::arg("scene"), nb::kw_only(), nb::arg("stations") = defaults.stations, nb::arg("points") = defaults.points,
      nb::arg("noise") = defaults.noise, nb::arg("station_distance") = defaults.station_distance,
      nb::arg("seed") = defaults.seed, docstring);
}

}  // namespace igsp::python
