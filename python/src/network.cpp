#include "igsp/network.hpp"

#include <fmt/format.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <map>
#include <mutex>

#include "arrays.hpp"
#include "igsp/errors.hpp"
#include "network/common_scale.hpp"
#include "network/inputs.hpp"
#include "network/outputs.hpp"
#include "options.hpp"
#include "portable.hpp"
#include "progress.hpp"

namespace igsp::python {
namespace {

// The caller's mistake about one scan, its file's fault or a package that is missing: that scan's problem.
bool is_problem_of_a_scan(const nb::python_error& error) {
  return error.matches(PyExc_ValueError) || error.matches(PyExc_OSError) || error.matches(PyExc_ImportError);
}

// Features from Python's `function(scan)`. What is no problem of a scan ends the run and is kept in `failure`.
FeatureSource features_of(nb::handle function, std::exception_ptr& failure) {
  return [function, &failure](std::size_t scan) {
    nb::gil_scoped_acquire lock;
    try {
      return nb::cast<Features>(function(scan));
    } catch (const nb::python_error& error) {
      if (is_problem_of_a_scan(error)) throw FileError(nb::str(error.value()).c_str());
      failure = std::current_exception();
      throw Cancelled();
    }
  };
}

// Scan, position and its sigma, world_from_scan's rotation as the upper left of a matrix and its sigma.
using ControlIn = std::tuple<std::size_t, VectorIn, double, std::optional<MatrixIn>, double>;

ControlPose control_of(const ControlIn& given) {
  const auto& [scan, position, sigma, rotation, rotation_sigma_rad] = given;
  ControlPose control{scan, vector_of(position), sigma, {}, rotation_sigma_rad};
  if (rotation) control.rotation = Eigen::Quaterniond(transformation_of(*rotation).linear()).normalized();
  return control;
}

void choose_pairs(NetworkOptions& options, const std::variant<std::string, std::vector<ScanPair>>& pairs) {
  if (const auto* listed = std::get_if<std::vector<ScanPair>>(&pairs)) {
    options.pairs = PairRule::listed;
    options.listed_pairs = *listed;
    return;
  }
  const std::string& rule = std::get<std::string>(pairs);
  if (rule != "all" && rule != "auto") {
    throw InvalidArgument(fmt::format("pairs is {}; it must be all, auto or pairs of indices", rule));
  }
  options.pairs = rule == "auto" ? PairRule::automatic : PairRule::all;
}

// Pairs that Python's `function(pairs, report)` registers elsewhere; it yields ((source, target), Result). Each is
// handed out once.
class PairsElsewhere {
 public:
  explicit PairsElsewhere(nb::handle function) : function_(function) {}

  PairStore store() {
    return {[this](std::size_t source, std::size_t target) {
              return take({source, target});
            },
            {},
            [this](std::span<const ScanPair> pairs, const std::function<void(double)>& report) { ask(pairs, report); }};
  }

 private:
  void ask(std::span<const ScanPair> pairs, const std::function<void(double)>& report) {
    nb::gil_scoped_acquire lock;
    const nb::object tick = nb::cpp_function([&report](double done) { report(done); });
    for (const nb::handle one : function_(std::vector<ScanPair>(pairs.begin(), pairs.end()), tick)) {
      auto [pair, result] = nb::cast<std::pair<ScanPair, Result>>(one);
      results_.emplace(pair, std::move(result));
    }
  }
  std::optional<Result> take(const ScanPair& pair) {
    const std::lock_guard lock(mutex_);
    auto found = results_.extract(pair);
    if (found.empty()) return {};
    return std::move(found.mapped());
  }

  nb::handle function_;
  std::mutex mutex_;
  std::map<ScanPair, Result> results_;
};

Network run(std::size_t scans, nb::handle features, nb::handle pairs_elsewhere, const Keywords& keywords,
            double min_unconfirmed_confidence, std::size_t min_unconfirmed_matches,
            const std::variant<std::string, std::vector<ScanPair>>& pairs, const std::optional<std::size_t>& fixed_scan,
            const std::vector<ControlIn>& control, nb::handle progress) {
  NetworkOptions options;
  options.pair = options_of(keywords);
  options.min_unconfirmed_confidence = min_unconfirmed_confidence;
  options.min_unconfirmed_matches = min_unconfirmed_matches;
  choose_pairs(options, pairs);
  options.fixed_scan = fixed_scan;
  for (const ControlIn& one : control) options.control.push_back(control_of(one));
  const ProgressCallback callback = progress_of(progress);
  std::exception_ptr failure;
  const FeatureSource source = features_of(features, failure);
  PairsElsewhere elsewhere(pairs_elsewhere);
  const PairStore store = pairs_elsewhere.is_none() ? PairStore() : elsewhere.store();
  nb::gil_scoped_release unlocked;
  try {
    return register_network(scans, source, options, callback, store);
  } catch (const Cancelled&) {
    if (failure) std::rethrow_exception(failure);
    throw;
  }
}

double own_voxel_size_of(const PointsIn& points, const Keywords& keywords) {
  const Options options = options_of(keywords);
  nb::gil_scoped_release unlocked;
  return own_voxel_size(scan_of(points, {}), options.scale);
}

std::vector<std::string> scan_files_of(const std::vector<std::string>& given) {
  std::vector<std::string> names;
  for (const auto& file : cli::scan_files({given.begin(), given.end()})) names.push_back(file.string());
  return names;
}

// One matrix a scan.
template <int size, typename Matrix>
Array<double, -1, size, size> stacked(const Network& network, const Matrix& matrix) {
  using RowMajor = Eigen::Matrix<double, size, size, Eigen::RowMajor>;
  const std::size_t count = network.scans.size();
  auto* numbers = new double[count * size * size];
  const nb::capsule owner(numbers, [](void* memory) noexcept { delete[] static_cast<double*>(memory); });
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Map<RowMajor>(numbers + i * size * size) = matrix(network.scans[i]);
  }
  return Array<double, -1, size, size>(numbers, {count, size, size}, owner);
}

void bind_scan(nb::module_& module) {
  portable_class<NetworkScan>(module, "NetworkScan", "A scan of a Network and where it lies.")
      .def_rw("name", &NetworkScan::name, "For people: its file, or \"scan 3\".")
      .def_ro("problem", &NetworkScan::problem, "Why there is nothing to register; empty if there is.")
      .def_ro("component", &NetworkScan::component, "Index into Network.components.")
      .def_prop_ro(
          "world_from_scan", [](const NetworkScan& scan) { return array_of(scan.world_from_scan); },
          nb::rv_policy::automatic, "(4, 4) float64; every component has a world of its own.")
      .def_prop_ro(
          "covariance", [](NetworkScan& scan) { return view(scan.covariance); },
          "(6, 6) float64 of world_from_scan: a small motion on the left, in the world: rotation about x, y, z "
          "through\n"
          "`centre` [rad], translation [units of the cloud]. 0 for the scan whose frame is the world.")
      .def_prop_ro(
          "centre", [](NetworkScan& scan) { return view(scan.centre); }, "(3,) float64: of its points, in the world.")
      .def_ro("points", &NetworkScan::points, "Points as given.")
      .def_ro(
          "control_residual", &NetworkScan::control_residual,
          "Distance between its control's position and where the network has it [units of the cloud]; None without.")
      .def("__repr__", [](const NetworkScan& scan) {
        return fmt::format("<NetworkScan {}: {}>", scan.name,
                           scan.problem.empty() ? fmt::format("component {}", scan.component) : scan.problem);
      });
}

void bind_link(nb::module_& module) {
  portable_class<NetworkLink>(module, "NetworkLink", "A pair of scans that was tried.")
      .def_ro("source", &NetworkLink::source, "Index of a scan.")
      .def_ro("target", &NetworkLink::target, "Index of a scan.")
      .def_prop_ro(
          "state", [](const NetworkLink& link) { return to_string(link.state); },
          "used, unconfirmed (used, but in no loop), rejected or not_registered.")
      .def_prop_ro(
          "origin", [](const NetworkLink& link) { return to_string(link.origin); },
          "pair; runner_up, the pair's second best pose; merged, the source and several scans at once.")
      .def_ro("merged", &NetworkLink::merged,
              "Where merged: indices of the scans of the merged cloud, the target first.")
      .def_ro("reason", &NetworkLink::reason, "One sentence.")
      .def_prop_ro(
          "target_from_source", [](const NetworkLink& link) { return array_of(link.target_from_source); },
          nb::rv_policy::automatic, "(4, 4) float64: as the pair alone has it.")
      .def_ro("confidence", &NetworkLink::confidence, "Of the pair alone, [0, 1].")
      .def_ro("overlap", &NetworkLink::overlap, "The smaller of the two directions, [0, 1].")
      .def_ro("rmse", &NetworkLink::rmse, "Inlier RMSE of the pair [units of the cloud].")
      .def_ro("mutual_matches", &NetworkLink::mutual_matches, "As in Evidence ...")
      .def_ro("agreeing_matches", &NetworkLink::agreeing_matches, "... and those of them that agree.")
      .def_ro("violation", &NetworkLink::violation, "Share of points where the other scanner saw through, [0, 1).")
      .def_ro("in_view", &NetworkLink::in_view, "Voxels of one scan in view of the other; 0 without both viewpoints.")
      .def_ro("consistent_triangles", &NetworkLink::consistent_triangles, "Cycles that close, with this link in them.")
      .def_ro("cycle_error", &NetworkLink::cycle_error, "Of these cycles, that of the best one [sigmas].")
      .def_ro("residual", &NetworkLink::residual,
              "RMS displacement of the source's points, pair against network [units of the cloud].")
      .def_ro("median_distance", &NetworkLink::median_distance,
              "Of the surfaces at the final poses, where they lie on each other; 0 unless used [units of the cloud].")
      .def_ro("rms_distance", &NetworkLink::rms_distance, "The same, RMS.")
      .def_ro("runner_up", &NetworkLink::runner_up, "Of the pair alone, or None.")
      .def_ro("precision", &NetworkLink::precision, "Of the pair alone.")
      .def("__repr__", [](const NetworkLink& link) {
        return fmt::format("<NetworkLink {} to {}: {}>", link.source, link.target, to_string(link.state));
      });
}

void bind_cycle(nb::module_& module) {
  portable_class<NetworkCycle>(module, "NetworkCycle", "A loop of three registered links.")
      .def_prop_ro(
          "scans",
          [](const NetworkCycle& cycle) { return nb::make_tuple(cycle.scans[0], cycle.scans[1], cycle.scans[2]); },
          nb::sig("def scans(self) -> tuple[int, int, int]"), "Their indices, ascending.")
      .def_ro("error", &NetworkCycle::error, "How far it is from closing, in sigmas.")
      .def_ro("closes", &NetworkCycle::closes, "False: one of its links is wrong.")
      .def("__repr__", [](const NetworkCycle& cycle) {
        return fmt::format("<NetworkCycle {}, {}, {}: {:.2f} sigma>", cycle.scans[0], cycle.scans[1], cycle.scans[2],
                           cycle.error);
      });
}

void bind_contradiction(nb::module_& module) {
  portable_class<NetworkContradiction>(
      module, "NetworkContradiction",
      "Two scans of one component that the network puts where the scanner of one saw through the other.")
      .def_prop_ro(
          "scans", [](const NetworkContradiction& pair) { return nb::make_tuple(pair.scans[0], pair.scans[1]); },
          nb::sig("def scans(self) -> tuple[int, int]"), "Their indices, ascending.")
      .def_ro("violation", &NetworkContradiction::violation, "Of free space, [0, 1).")
      .def("__repr__", [](const NetworkContradiction& pair) {
        return fmt::format("<NetworkContradiction {}, {}: {:.3f}>", pair.scans[0], pair.scans[1], pair.violation);
      });
}

}  // namespace

void bind_network(nb::module_& module) {
  bind_scan(module);
  bind_link(module);
  bind_cycle(module);
  bind_contradiction(module);
  portable_class<Network>(module, "Network",
                          "What `network` answers: where every scan lies, and which pairs to trust. Scans that do not\n"
                          "connect stay in components of their own, each with a world of its own.")
      .def_ro("scans", &Network::scans, nb::rv_policy::reference_internal, "In the order given.")
      .def_ro("links", &Network::links, "All pairs that were tried, then second looks.")
      .def_ro("cycles", &Network::cycles, "All loops of three registered links.")
      .def_ro("components", &Network::components, "Indices of scans, ascending; the largest component first.")
      .def_ro("contradictions", &Network::contradictions,
              "Pairs of scans with more than 1 % in space that was seen through, at the final poses, the worst first.")
      .def_prop_ro(
          "poses",
          [](const Network& network) {
            return stacked<4>(network, [](const NetworkScan& scan) { return scan.world_from_scan.matrix(); });
          },
          nb::rv_policy::automatic, "(N, 4, 4) float64: world_from_scan of every scan.")
      .def_prop_ro(
          "covariances",
          [](const Network& network) {
            return stacked<6>(network, [](const NetworkScan& scan) { return scan.covariance; });
          },
          nb::rv_policy::automatic, "(N, 6, 6) float64: NetworkScan.covariance of every scan.")
      .def_ro("bundle_error", &Network::bundle_error,
              "RMS of the residuals of the links that are used [units of the cloud].")
      .def_ro("voxel_size", &Network::voxel_size, "[units of the cloud].")
      .def_ro("warnings", &Network::warnings, "What of the arguments could not be followed, a sentence each.")
      .def("__str__",
           [](const Network& network) {
             std::string text = cli::network_summary(network);
             text.pop_back();
             return text;
           })
      .def("__repr__", [](const Network& network) {
        return fmt::format("<Network: {} scans, {} links, {} components>", network.scans.size(), network.links.size(),
                           network.components.size());
      });
  module.def("register_network", &run, nb::arg("scans"), nb::arg("features"), nb::arg("pairs_elsewhere").none(),
             nb::arg("options"), nb::arg("min_unconfirmed_confidence"), nb::arg("min_unconfirmed_matches"),
             nb::arg("pairs"), nb::arg("fixed_scan").none(), nb::arg("control"), nb::arg("progress").none());
  module.def("own_voxel_size", &own_voxel_size_of, nb::arg("points").noconvert(), nb::arg("options"));
  module.def("common_voxel_size", &common_voxel_size, nb::arg("own"));
  module.def("scan_files", &scan_files_of, nb::arg("given"));
}

}  // namespace igsp::python
