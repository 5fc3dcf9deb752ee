#include "command_line.hpp"

#include <fmt/format.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cctype>
#include <memory>
#include <new>

#include "arrays.hpp"
#include "bindings.hpp"
#include "igsp/errors.hpp"

namespace igsp::python {
namespace {

namespace fs = std::filesystem;

// Without the "[Errno 2] " that Python puts before what the system says of a file.
std::string message_of(nb::handle error) {
  const nb::object file = nb::getattr(error, "filename", nb::none()),
                   reason = nb::getattr(error, "strerror", nb::none());
  if (file.is_none() || reason.is_none()) return nb::str(error).c_str();
  return fmt::format("{}: {}", nb::str(file).c_str(), nb::str(reason).c_str());
}

// Runs `body` with the interpreter lock. What Python raises becomes the error that the command knows how to tell.
template <typename Body>
auto in_python(const Body& body) {
  nb::gil_scoped_acquire lock;
  try {
    return body();
  } catch (nb::python_error& error) {
    const std::string message = message_of(error.value());
    if (error.matches(PyExc_KeyboardInterrupt)) throw Cancelled();
    if (error.matches(PyExc_OSError) || error.matches(PyExc_ImportError)) throw FileError(message);
    if (error.matches(PyExc_MemoryError)) throw std::bad_alloc();
    if (error.matches(PyExc_ValueError)) throw InvalidArgument(message);
    throw std::runtime_error(error.what());  // its text must be made now, with the lock
  }
}

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

void delete_in_python(Chunks* chunks) {
  nb::gil_scoped_acquire lock;
  delete chunks;
}

cli::ForeignCloud open(nb::handle formats, const fs::path& path) {
  return in_python([&] {
    const nb::object iterator = formats.attr("read_chunks")(path.string());
    const std::shared_ptr<Chunks> chunks(new Chunks{iterator, {}}, delete_in_python);
    std::string name = cli::file_of_scan(path).extension().string().substr(1);
    for (char& letter : name) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    return cli::ForeignCloud{
        .format = name,
        .next_chunk = [chunks] { return next_chunk(*chunks); },
        .dropped =
            [chunks] { return in_python([&] { return nb::cast<std::size_t>(chunks->iterator.attr("dropped")); }); },
        .viewpoint = [chunks] { return in_python([&] { return point_of(chunks->iterator.attr("viewpoint")); }); },
        .scans =
            [chunks] { return in_python([&] { return nb::cast<std::size_t>(chunks->iterator.attr("scan_count")); }); },
        .note = [chunks] { return in_python([&] { return nb::cast<std::string>(chunks->iterator.attr("note")); }); }};
  });
}

// `formats` must outlive them.
cli::ForeignFormats foreign_formats(nb::handle formats) {
  return {
      .reads =
          [formats](const fs::path& path) {
            return in_python([&] { return nb::cast<bool>(formats.attr("is_supported")(path.string())); });
          },
      .open = [formats](const fs::path& path) { return open(formats, path); },
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
      .on_interrupt = PyErr_SetInterrupt};
}

int run(std::vector<std::string> arguments, nb::handle formats) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  int exit_code;
  {
    nb::gil_scoped_release unlocked;
    exit_code = cli::run(static_cast<int>(arguments.size()), pointers.data(), foreign_formats(formats));
    cli::use_foreign_formats({});
  }
  if (PyErr_CheckSignals() != 0) PyErr_Clear();  // an interrupt that no Python code met: the exit code tells it
  return exit_code;
}

}  // namespace

void bind_command_line(nb::module_& module) {
  module.def("run_command_line", &run, nb::arg("arguments"), nb::arg("formats"),
             "The igsp command: the first argument is its name, `formats` are igsp.survey_formats. Returns the exit "
             "code.");
}

}  // namespace igsp::python
