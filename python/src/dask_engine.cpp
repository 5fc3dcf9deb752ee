#include "dask_engine.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <optional>
#include <tuple>

#include "core/report_progress.hpp"
#include "foreign_formats.hpp"
#include "igsp/align.hpp"
#include "in_python.hpp"
#include "network/fingerprint.hpp"
#include "network/store.hpp"
#include "options.hpp"

namespace igsp::python {
namespace {

namespace fs = std::filesystem;

// How a worker reads a scan: its absolute name, where the scanner is said to have stood, columns,
// keep_noise, max_points.
using ScanSource =
    std::tuple<std::string, std::optional<std::array<double, 3>>, std::vector<std::string>, bool, std::size_t>;

ScanSource source_of(const cli::ScanReading& reading, const fs::path& file) {
  std::optional<std::array<double, 3>> place;
  if (const auto given = reading.viewpoints.find(file); given != reading.viewpoints.end()) {
    place = {given->second.x(), given->second.y(), given->second.z()};
  }
  return {fs::absolute(file).string(), place, reading.read.columns, reading.read.keep_noise, reading.max_points};
}

cli::ScanReading reading_of(const ScanSource& source) {
  const auto& [name, place, columns, keep_noise, max_points] = source;
  cli::ScanReading reading;
  reading.files = {name};
  if (place) reading.viewpoints[name] = Eigen::Vector3d(place->data());
  reading.read.columns = columns;
  reading.read.keep_noise = keep_noise;
  reading.max_points = max_points;
  return reading;
}

// Calls of an igsp.command_engine.CommandEngine. Python holds a function that stops its waiting: where the command was
// interrupted, it raises igsp.Cancelled.
class Dask : public cli::Engine {
 public:
  Dask(const std::string& scheduler, const cli::ScanReading& reading, const cli::Warn& warn) {
    in_python([&] {
      nb::list sources, names;
      for (const fs::path& file : reading.files) {
        sources.append(source_of(reading, file));
        names.append(file.string());
      }
      engine_ = nb::module_::import_("igsp.command_engine")
                    .attr("CommandEngine")(scheduler, sources, names,
                                           nb::cpp_function([warn](const std::string& line) { warn(line); }));
    });
  }
  ~Dask() override {
    nb::gil_scoped_acquire lock;
    try {
      engine_.attr("close")();
    } catch (const nb::python_error&) {
      // The scheduler is gone already.
    }
    engine_.reset();
  }

  cli::ScanLook look(std::size_t scan, const Options& options, const ProgressCallback& progress) override {
    return in_python([&] {
      const auto [voxel_size, extent] = nb::cast<std::pair<double, double>>(
          engine_.attr("look")(scan, keywords_of(options), tick(progress, "look at scans")));
      return cli::ScanLook{voxel_size, extent};
    });
  }
  std::string fingerprint(std::size_t scan, const ProgressCallback& progress) override {
    return in_python(
        [&] { return nb::cast<std::string>(engine_.attr("fingerprint")(scan, tick(progress, "fingerprints"))); });
  }
  Features features(std::size_t scan, const Options& options, const ProgressCallback& progress) override {
    return in_python([&] {
      return nb::cast<Features>(engine_.attr("features")(scan, keywords_of(options), tick(progress, "features")));
    });
  }
  bool works_ahead() const override { return true; }
  void expect(std::span<const std::size_t> scans, const Options& options) override {
    in_python(
        [&] { engine_.attr("expect")(std::vector<std::size_t>(scans.begin(), scans.end()), keywords_of(options)); });
  }
  void register_pairs(std::span<const ScanPair> pairs, const Options& options, const Keep& keep,
                      const std::function<void(double)>& report) override {
    in_python([&] {
      const nb::object keep_one = nb::cpp_function([&](const ScanPair& pair, const Result& result) {
        nb::gil_scoped_release unlocked;
        keep(pair, result);
      });
      engine_.attr("register_pairs")(std::vector<ScanPair>(pairs.begin(), pairs.end()), keywords_of(options), keep_one,
                                     nb::cpp_function([&](double done) { report(done); }));
    });
  }

 private:
  // Valid as long as `progress`.
  static nb::object tick(const ProgressCallback& progress, const char* stage) {
    return nb::cpp_function([&progress, stage](double done) { report_progress(progress, stage, done); });
  }

  nb::object engine_;
};

// What workers do. They are processes of their own, where nobody has said who reads survey formats.
void know_formats(nb::handle formats) {
  static const bool known = [&] {
    cli::use_foreign_formats(foreign_formats(formats));
    return true;
  }();
  static_cast<void>(known);
}

std::pair<double, double> look_at(const ScanSource& source, const Keywords& keywords, nb::handle formats) {
  know_formats(formats);
  const Options options = options_of(keywords);
  nb::gil_scoped_release unlocked;
  const cli::ScanLook look = cli::look_at_scan(reading_of(source), 0, options.scale, {});
  return {look.voxel_size, look.extent};
}

std::string fingerprint_of(const ScanSource& source) {
  nb::gil_scoped_release unlocked;
  return cli::fingerprint_of_file(cli::file_of_scan(std::get<0>(source)));
}

Features features_of(const ScanSource& source, const Keywords& keywords, nb::handle formats) {
  know_formats(formats);
  const Options options = options_of(keywords);
  nb::gil_scoped_release unlocked;
  return cli::read_features(reading_of(source), 0, options, {});
}

Result pair_of(const Features& source, const Features& target, const Keywords& keywords) {
  const Options options = options_of(keywords);
  nb::gil_scoped_release unlocked;
  return cli::without_details(align(source, target, options));
}

}  // namespace

cli::DaskEngine dask_engine() {
  return [](const std::string& scheduler, const cli::ScanReading& reading, const cli::Warn& warn) {
    return std::make_unique<Dask>(scheduler, reading, warn);
  };
}

void bind_dask_engine(nb::module_& module) {
  module.def("look_at_scan", &look_at, nb::arg("source"), nb::arg("options"), nb::arg("formats"));
  module.def("fingerprint_of_scan", &fingerprint_of, nb::arg("source"));
  module.def("features_of_scan", &features_of, nb::arg("source"), nb::arg("options"), nb::arg("formats"));
  module.def("register_pair", &pair_of, nb::arg("source"), nb::arg("target"), nb::arg("options"),
             "As `align`; without what a network does not look at.");
  module.def(
      "method_number", [] { return std::string(cli::method_number); },
      "Of the sources that answers are made by: processes whose numbers differ must not mix their answers.");
}

}  // namespace igsp::python
