#include "foreign_formats.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cctype>
#include <memory>

#include "arrays.hpp"
#include "in_python.hpp"

namespace igsp::python {
namespace {

namespace fs = std::filesystem;

// The iterator that igsp.formats.read_chunks returns, and its latest chunk.
struct Chunks {
  nb::object iterator;
  PointsIn points;
};

PointView next_chunk(Chunks& chunks) {
  return in_python([&] {
    const nb::object array = nb::steal(PyIter_Next(chunks.iterator.ptr()));
    if (PyErr_Occurred()) throw nb::python_error();
    if (!array.is_valid()) return PointView();
    chunks.points = nb::cast<PointsIn>(array);
    return view_of(chunks.points);
  });
}

std::optional<Eigen::Vector3d> point_of(nb::handle array) {
  if (array.is_none()) return std::nullopt;
  return vector_of(nb::cast<VectorIn>(array));
}

// Of several scans; a single one has no parts.
std::vector<ScanPart> parts_of(nb::handle parts) {
  std::vector<ScanPart> all;
  for (const nb::handle part : parts) {
    all.push_back({nb::cast<std::size_t>(part.attr("point_count")), point_of(part.attr("viewpoint"))});
  }
  return all;
}

void delete_in_python(Chunks* chunks) {
  nb::gil_scoped_acquire lock;
  delete chunks;
}

cli::ForeignCloud open(nb::handle formats, const fs::path& path, bool keep_noise) {
  return in_python([&] {
    const nb::object iterator = formats.attr("read_chunks")(path.string(), nb::arg("keep_noise") = keep_noise);
    const std::shared_ptr<Chunks> chunks(new Chunks{iterator, {}}, delete_in_python);
    std::string name = cli::file_of_scan(path).extension().string().substr(1);
    for (char& letter : name) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    return cli::ForeignCloud{
        .format = name,
        .next_chunk = [chunks] { return next_chunk(*chunks); },
        .dropped =
            [chunks] { return in_python([&] { return nb::cast<std::size_t>(chunks->iterator.attr("dropped")); }); },
        .noise =
            [chunks] {
              return in_python([&] { return nb::cast<std::size_t>(chunks->iterator.attr("metadata").attr("noise")); });
            },
        .part = [chunks] { return in_python([&] { return nb::cast<std::size_t>(chunks->iterator.attr("part")); }); },
        .viewpoint = [chunks] { return in_python([&] { return point_of(chunks->iterator.attr("viewpoint")); }); },
        .parts = [chunks] { return in_python([&] { return parts_of(chunks->iterator.attr("parts")); }); }};
  });
}

}  // namespace

cli::ForeignFormats foreign_formats(nb::handle formats) {
  return {
      .reads =
          [formats](const fs::path& path) {
            return in_python([&] { return nb::cast<bool>(formats.attr("is_supported")(path.string())); });
          },
      .open = [formats](const fs::path& path, bool keep_noise) { return open(formats, path, keep_noise); },
      .scans =
          [formats](const fs::path& path) {
            return in_python([&] { return nb::cast<std::vector<std::string>>(formats.attr("scans")(path.string())); });
          },
      .moves =
          [formats](const fs::path& source, const fs::path& output) {
            return in_python([&] { return nb::cast<bool>(formats.attr("moves")(source.string(), output.string())); });
          },
      .write_moved =
          [formats](const fs::path& source, const fs::path& output, const Transformation& motion) {
            in_python([&] { formats.attr("write_aligned")(source.string(), output.string(), array_of(motion)); });
          },
      .writes_points =
          [formats](const fs::path& path) {
            return in_python([&] { return nb::cast<bool>(formats.attr("writes_points")(path.string())); });
          },
      .write_points =
          [formats](const fs::path& path, const ChunkSource& chunks, const cli::CoordinateGrid& grid) {
            in_python([&] {
              const nb::object next_chunk = nb::cpp_function([&chunks] {
                const PointView chunk = chunks();
                return array_of(Points(chunk.begin(), chunk.end()));
              });
              const nb::tuple offset = nb::make_tuple(grid.offset.x(), grid.offset.y(), grid.offset.z());
              formats.attr("write_points")(path.string(), next_chunk, offset, grid.scale);
            });
          },
      .on_interrupt = PyErr_SetInterrupt};
}

}  // namespace igsp::python
