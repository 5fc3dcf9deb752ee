#include "igsp/simulation.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"

namespace igsp::python {

void bind_simulation(nb::module_& module) {
  nb::class_<SimulatedScan>(module, "SimulatedScan", "One scan in the scanner's own frame, its origin is the sensor.")
      .def_prop_ro(
          "points", [](const SimulatedScan& scan) { return array_of(scan.points); }, "(N, 3) float64 [m].")
      .def_prop_ro(
          "world_from_scanner", [](const SimulatedScan& scan) { return array_of(scan.world_from_scanner); },
          nb::rv_policy::automatic, "(4, 4) float64: where the scanner stood.")
      .def("__repr__",
           [](const SimulatedScan& scan) { return fmt::format("<SimulatedScan: {} points>", scan.points.size()); });
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
      nb::arg("scene"), nb::kw_only(), nb::arg("stations") = 2, nb::arg("points") = 200000,
      nb::arg("noise") = nb::none(), nb::arg("station_distance") = 0.0, nb::arg("seed") = 7,
      "Scans of a simulated \"park\" or \"indoor\" by a levelled terrestrial scanner of unknown yaw, or of an "
      "\"object\"\n"
      "of 0.2 m by a range camera in any pose, by ray casting. `points` is about what a station gets, `noise` the\n"
      "standard deviation along the ray [m] (None: the scene's own), `station_distance` that between neighbouring\n"
      "stations [m] (0: the scene's own); every seed is another scene. The same arguments give the same scans.");
}

}  // namespace igsp::python
