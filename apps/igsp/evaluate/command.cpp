#include <fmt/format.h>

#include <iostream>
#include <limits>
#include <numbers>

#include "evaluate/trajectory.hpp"
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
  fs::path transformation, truth, source, written;
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

int evaluate_trajectory(const TrajectoryError& error, bool json) {
  const auto degrees = [](double radians) { return radians * 180.0 / std::numbers::pi; };
  const ErrorRange &e_r = error.step_rotation_rad, &e_t = error.step_translation;
  if (json) {
    const auto range = [](double mean, double max) { return Json{{"mean", mean}, {"max", max}}; };
    const Json report = {
        {"poses", error.poses},
        {"relative", {{"e_r_deg", range(degrees(e_r.mean), degrees(e_r.max))}, {"e_t", range(e_t.mean, e_t.max)}}},
        {"absolute", {{"rmse", error.position_rmse}, {"mean", error.position.mean}, {"max", error.position.max}}}};
    std::cout << report.dump(2) << "\n";
    return exit_registered;
  }
  std::cout << fmt::format("poses     {} in both files\n", error.poses);
  std::cout << fmt::format(
      "relative  e_r mean {:.6g}, max {:.6g} deg; e_t mean {:.6g}, max {:.6g} (consecutive poses)\n", degrees(e_r.mean),
      degrees(e_r.max), e_t.mean, e_t.max);
  std::cout << fmt::format("absolute  RMSE {:.6g}, mean {:.6g}, max {:.6g} (positions, after the best rigid motion)\n",
                           error.position_rmse, error.position.mean, error.position.max);
  return exit_registered;
}

int run_evaluate(const EvaluateSettings& settings) {
  const std::vector<io::TimedPose> estimates = io::read_poses(settings.transformation),
                                   truths = io::read_poses(settings.truth);
  if (!settings.written.empty()) io::write_poses(settings.written, estimates);
  if (estimates.size() > 1 || truths.size() > 1) {
    if (!settings.source.empty()) throw InvalidArgument("--source belongs to one transformation, not to a trajectory");
    return evaluate_trajectory(trajectory_error(estimates, truths), settings.json);
  }
  const Transformation &estimate = estimates[0].pose, &truth = truths[0].pose;
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
    "  igsp evaluate --transform survey/poses.tum --truth truth.tum --write poses.kitti\n"
    "A file holds target_from_source as 4x4 text, rows in order, or a trajectory: TUM (time x y z qx qy qz qw, a pose "
    "a\n"
    "line) or KITTI (the 12 numbers of the upper three rows). Trajectories are compared pose by pose: relative errors "
    "of\n"
    "consecutive poses, absolute errors of positions after the rigid motion that fits best.\n"
    "Of two transformations e_r and e_t are Eq. 12-13 of the paper; e_t depends on where the origin is,\n"
    "the displacement of the source's centroid does not.";

}  // namespace

void add_evaluate_command(CLI::App& app, Command& command) {
  CLI::App* evaluate = app.add_subcommand("evaluate", "error of a transformation against the true one");
  const auto settings = std::make_shared<EvaluateSettings>();
  evaluate->add_option("--transform", settings->transformation, "estimated target_from_source, or a trajectory")
      ->required()
      ->type_name("FILE");
  evaluate->add_option("--truth", settings->truth, "true target_from_source, or a trajectory")
      ->required()
      ->type_name("FILE");
  evaluate->add_option("--source", settings->source, "source cloud, for the displacement of its centroid")
      ->type_name("FILE");
  evaluate->add_option("--write", settings->written, "write what --transform holds as FILE: .tum, .kitti, or 4x4 text")
      ->type_name("FILE");
  evaluate->add_flag("--json", settings->json, "print JSON");
  evaluate->footer(examples);
  evaluate->callback([settings, &command] { command = [settings] { return run_evaluate(*settings); }; });
}

}  // namespace igsp::cli
