#include "igsp/features.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "options.hpp"
#include "portable.hpp"
#include "progress.hpp"

namespace igsp::python {
namespace {

template <auto member>
auto view(const Features& self) {
  return read_only_view(self.*member);
}

Features extract(const PointsIn& cloud, const PartsIn& parts, const Keywords& keywords, nb::handle progress) {
  const Options options = options_of(keywords);
  const ProgressCallback callback = progress_of(progress);
  nb::gil_scoped_release unlocked;
  return extract_features(scan_of(cloud, parts), options, callback);
}

}  // namespace

void bind_features(nb::module_& module) {
  portable_class<Features>(module, "Features",
                           "What the method knows of one cloud. Coordinates are relative to `origin` (world = local + "
                           "origin). N voxels, K keypoints. Its arrays are read-only.")
      .def_prop_ro("origin", &view<&Features::origin>, "(3,) float64.")
      .def_prop_ro(
          "viewpoint", [](const Features& features) { return array_of(features.viewpoint); }, nb::rv_policy::automatic,
          "(3,) float64: where the scanner stood, local; None: unknown, or several.")
      .def_prop_ro(
          "part_viewpoints",
          [](const Features& features) {
            Points places;
            for (const ScannedPart& part : features.parts) places.push_back(part.viewpoint);
            return array_of(std::move(places));
          },
          nb::rv_policy::automatic, "(K, 3) float64: of a cloud of several scans, those that are known, local.")
      .def_ro("voxel_size", &Features::voxel_size, "[units of the cloud].")
      .def_prop_ro("points", &view<&Features::points>, "(N, 3) float64: voxel centroids, local.")
      .def_prop_ro("curvature", &view<&Features::curvature>, "(N,) float32: surface variation, [0, 1/3].")
      .def_prop_ro("normals", &view<&Features::normals>, "(N, 3) float64: unit, sign arbitrary.")
      .def_prop_ro("fine_points", &view<&Features::fine_points>,
                   "(M, 3) float64: centroids of finer voxels, local: what fine registration works on.")
      .def_prop_ro("keypoints", &view<&Features::keypoints>,
                   "(K,) uint32: indices into `points`, by curvature descending.")
      .def_prop_ro("frames", &view<&Features::frames>,
                   "(K, 3, 3) float64: columns x, y, n of the local reference frame.")
      .def_prop_ro("descriptors", &view<&Features::descriptors>,
                   "(K, 7) uint64: Binary Shape Context, 435 bits padded to 448.")
      .def_ro("coarser", &Features::coarser,
              "List of Features: the same at voxels of 2, 4 and 8 times the size, as far as there are enough of them.")
      .def_ro("cloud_points", &Features::cloud_points, "Points of the cloud as given.")
      .def_ro("timings_s", &Features::timings_s, "(stage, wall seconds), in order.")
      .def("__repr__", [](const Features& features) {
        return fmt::format("<Features: {} keypoints of {} voxels of {:.4g}>", features.keypoints.size(),
                           features.points.size(), features.voxel_size);
      });
  module.def("extract_features", &extract, nb::arg("cloud").noconvert(), nb::arg("parts").noconvert(),
             nb::arg("options"), nb::arg("progress").none());
}

}  // namespace igsp::python
