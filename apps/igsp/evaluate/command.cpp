#include <fmt/format.h>

#include <iostream>
#include <limits>
#include <numbers>

#include "files/cloud_file.hpp"
#include "igsp/errors.hpp"
#include "igsp/evaluation.hpp"
#include "igsp/io.hpp"
#include "report/json.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/interrupt.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

struct EvaluateSettings {
  fs::path transformation, truth, source;
  bool json = false;
};

Eigen::Vector3d centroid_of(const fs::path& path) {
  CloudFile reader(path);
  // Sums relative to the first point: survey coordinates lose nothing.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (PointView chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
    stop_if_interrupted();
    if (count == 0) origin = chunk.front();
    for (const Eigen::Vector3d& point : chunk) sum += point - origin;
    count += chunk.size();
  }
  if (count == 0) throw FileError(path.string() + ": holds no finite point");
  return origin + sum / static_cast<double>(count);
}

int run_evaluate(const EvaluateSettings& settings) {
  const Transformation estimate = read_transformation(settings.transformation);
  const Transformation truth = read_transformation(settings.truth);
  const bool has_source = !settings.source.empty();
  const Eigen::Vector3d centroid = has_source ? centroid_of(settings.source) : Eigen::Vector3d::Zero();
  const PoseError error = pose_error(estimate, truth, centroid);
  const double degrees = error.rotation_rad * 180.0 / std::numbers::pi;
  if (settings.json) {
    Json json = {{"e_r_deg", degrees}, {"e_r_mdeg", 1000 * degrees}, {"e_t", error.translation}};
    json["centroid_displacement"] = has_source ? Json(error.centroid_displacement) : Json(nullptr);
    std::cout << json.dump(2) << "\n";
    return exit_registered;
  }
  std::cout << fmt::format("e_r  {:.6g} deg = {:.6g} mdeg\n", degrees, 1000 * degrees);
  std::cout << fmt::format("e_t  {:.6g} (depends on the origin)\n", error.translation);
  if (has_source) {
    std::cout << fmt::format("centroid displacement  {:.6g}\n", error.centroid_displacement);
  } else {
    std::cout << "centroid displacement  needs --source\n";
  }
  return exit_registered;
}

constexpr const char* examples =
    "Example:\n"
    "  igsp evaluate --transform T.txt --truth T_gt.txt --source a.ply\n"
    "Both files hold target_from_source as 4x4 text, rows in order. e_r and e_t are Eq. 12-13 of the paper; e_t\n"
    "depends on where the origin is, the displacement of the source's centroid does not.";

}  // namespace

void add_evaluate_command(CLI::App& app, Command& command) {
  CLI::App* evaluate = app.add_subcommand("evaluate", "error of a transformation against the true one");
  const auto settings = std::make_shared<EvaluateSettings>();
  evaluate->add_option("--transform", settings->transformation, "estimated target_from_source")
      ->required()
      ->type_name("FILE");
  evaluate->add_option("--truth", settings->truth, "true target_from_source")->required()->type_name("FILE");
  evaluate->add_option("--source", settings->source, "source cloud, for the displacement of its centroid")
      ->type_name("FILE");
  evaluate->add_flag("--json", settings->json, "print JSON");
  evaluate->footer(examples);
  evaluate->callback([settings, &command] { command = [settings] { return run_evaluate(*settings); }; });
}

}  // namespace igsp::cli
