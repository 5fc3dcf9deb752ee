#include <fmt/format.h>

#include <iostream>

#include "files/output_file.hpp"
#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "igsp/simulation.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/interrupt.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

struct SimulateSettings {
  std::string scene;
  fs::path folder;
  SimulationOptions options;
};

int run_simulate(const SimulateSettings& settings) {
  make_folder(settings.folder);
  check_writable(settings.folder / "station_0.ply");
  const std::vector<SimulatedScan> scans = simulate(settings.scene, settings.options);
  const auto file = [&](const std::string& name) { return settings.folder / name; };
  for (std::size_t i = 0; i < scans.size(); ++i) {
    stop_if_interrupted();
    const fs::path cloud = file(fmt::format("station_{}.ply", i));
    write_points(cloud, scans[i].points, {.single_precision = true, .viewpoint = scans[i].viewpoint});
    std::cout << fmt::format("{}  {} points\n", cloud.string(), scans[i].points.size());
  }
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const fs::path truth = file(fmt::format("station_{}_to_0.txt", i));
    write_transformation(truth, scans[0].world_from_scanner.inverse() * scans[i].world_from_scanner);
    std::cout << fmt::format("{}  true target_from_source, source station_{}, target station_0\n", truth.string(), i);
  }
  if (scans.size() < 2) return exit_registered;
  const std::string source = file("station_1.ply"), target = file("station_0.ply"), truth = file("station_1_to_0.txt");
  std::cout << fmt::format("try: igsp align {} {} --transform T.txt\n", source, target);
  std::cout << fmt::format("     igsp evaluate --transform T.txt --truth {} --source {}\n", truth, source);
  return exit_registered;
}

constexpr const char* examples =
    "Example:\n"
    "  igsp simulate park --out scans --stations 3 --seed 1\n"
    "Every scan is in the frame of its own scanner; station_1_to_0.txt is the true target_from_source for station_1\n"
    "as source and station_0 as target.";

}  // namespace

void add_simulate_command(CLI::App& app, Command& command) {
  CLI::App* simulate = app.add_subcommand("simulate", "scans of a made-up scene with their true relation");
  const auto settings = std::make_shared<SimulateSettings>();
  SimulationOptions& options = settings->options;
  simulate->add_option("SCENE", settings->scene, "what is scanned")->required()->type_name("park|indoor|object");
  simulate->add_option("--out", settings->folder, "folder for the files, made if missing")
      ->required()
      ->type_name("DIR");
  simulate->add_option("--stations", options.stations, "number of scans, in [1, 64]; default 2")->type_name("INTEGER");
  simulate->add_option("--points", options.points, "points of a scan, about; default 200000")->type_name("INTEGER");
  simulate->add_option("--noise", options.noise, "standard deviation along the ray [m]; default: the scene's own")
      ->type_name("NUMBER");
  simulate
      ->add_option("--station-distance", options.station_distance,
                   "between neighbouring stations [m]; default 0: the scene's own")
      ->type_name("NUMBER");
  simulate->add_option("--seed", options.seed, "every seed is another scene; default 7")->type_name("INTEGER");
  simulate->footer(examples);
  simulate->callback([settings, &command] { command = [settings] { return run_simulate(*settings); }; });
}

}  // namespace igsp::cli
