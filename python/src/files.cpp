#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include "arrays.hpp"
#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "progress.hpp"

namespace igsp::python {
namespace {

// igsp::read_points, stopped by Ctrl-C between two chunks.
LoadedCloud read_interruptibly(const std::string& path) {
  const ProgressCallback check_signals = progress_of(nb::none());
  nb::gil_scoped_release unlocked;
  PointReader reader(path);
  LoadedCloud cloud;
  cloud.points.reserve(reader.declared_points());
  for (PointView chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
    cloud.points.insert(cloud.points.end(), chunk.begin(), chunk.end());
    check_signals({"read", 0.0});
  }
  cloud.dropped = reader.dropped();
  cloud.viewpoint = reader.viewpoint();
  return cloud;
}

}  // namespace

void bind_files(nb::module_& module) {
  module.def(
      "read_points",
      [](const std::string& path) {
        LoadedCloud cloud = read_interruptibly(path);
        return std::tuple(array_of(std::move(cloud.points)), cloud.dropped, array_of(cloud.viewpoint));
      },
      nb::arg("path"),
      "(N, 3) float64, the number of points dropped for a coordinate that is not finite, and the "
      "viewpoint that the file states.");
  module.def(
      "write_points",
      [](const std::string& path, const PointsIn& points, bool single_precision,
         const std::optional<VectorIn>& viewpoint) {
        nb::gil_scoped_release unlocked;
        WriteOptions options{.single_precision = single_precision};
        if (viewpoint) options.viewpoint = vector_of(*viewpoint);
        write_points(path, view_of(points), options);
      },
      nb::arg("path"), nb::arg("points").noconvert(), nb::arg("single_precision"),
      nb::arg("viewpoint").noconvert().none());
  module.def(
      "read_transformation", [](const std::string& path) { return array_of(read_transformation(path)); },
      nb::arg("path"));
  module.def(
      "write_transformation",
      [](const std::string& path, const MatrixIn& matrix) { write_transformation(path, transformation_of(matrix)); },
      nb::arg("path"), nb::arg("transformation").noconvert());
}

}  // namespace igsp::python
