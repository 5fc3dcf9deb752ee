#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "config/option_list.hpp"
#include "files/output_file.hpp"
#include "files/read_flags.hpp"
#include "igsp/errors.hpp"
#include "network/engine.hpp"
#include "network/first_look.hpp"
#include "network/inputs.hpp"
#include "network/moved_scans.hpp"
#include "network/outputs.hpp"
#include "network/page.hpp"
#include "network/store.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/help_text.hpp"
#include "shell/interrupt.hpp"
#include "shell/option_flags.hpp"
#include "shell/progress_bar.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t held_scans = 64;  // the features of others are read from the cache when they are needed

struct NetworkSettings {
  std::vector<fs::path> scans;
  fs::path folder, viewpoints, control;
  fs::path moved, merged;
  std::string fixed_scan, engine = "local", scheduler;
  bool levelled = false;
  std::string pairs = "all";  // or "auto", or a file
  ReadOptions read;
  std::int64_t max_points = 20'000'000;
  NetworkOptions options;
  bool quiet = false;
  std::shared_ptr<OptionFlags> option_flags;
};

ScanReading reading_of(const NetworkSettings& settings) {
  ScanReading reading;
  reading.files = scan_files(settings.scans);
  if (reading.files.size() < 2) throw InvalidArgument("a network needs at least two scans");
  if (!settings.viewpoints.empty()) reading.viewpoints = read_viewpoints(settings.viewpoints, reading.files);
  reading.read = settings.read;
  reading.max_points = static_cast<std::size_t>(settings.max_points);
  return reading;
}

void choose_world(NetworkOptions& options, const NetworkSettings& settings, const std::vector<fs::path>& files) {
  if (settings.levelled) options.pair.degrees_of_freedom = 4;
  if (!settings.fixed_scan.empty() && !settings.control.empty()) {
    throw InvalidArgument("--fix and --control both say what the world is: give one of them");
  }
  if (!settings.fixed_scan.empty()) options.fixed_scan = scan_named(settings.fixed_scan, files, "--fix");
  if (!settings.control.empty()) options.control = read_control(settings.control, files);
}

std::unique_ptr<Engine> engine_for(const NetworkSettings& settings, const ScanReading& reading) {
  const bool is_dask = settings.engine == "dask";
  if (!is_dask && settings.engine != "local") {
    throw InvalidArgument(fmt::format("--engine is {}; it must be local or dask", settings.engine));
  }
  if (is_dask == settings.scheduler.empty()) {
    throw InvalidArgument("--engine dask and --scheduler ADDRESS belong together: give both, or neither");
  }
  if (!is_dask) return local_engine(reading);
  return dask_engine(settings.scheduler, reading, [quiet = settings.quiet](const std::string& line) {
    if (!quiet) std::cerr << "igsp: warning: " << line << "\n";
  });
}

void choose_pairs(NetworkOptions& options, const std::string& pairs, const std::vector<fs::path>& files) {
  if (pairs == "all") return;
  options.pairs = pairs == "auto" ? PairRule::automatic : PairRule::listed;
  if (options.pairs == PairRule::listed) options.listed_pairs = read_pairs(pairs, files);
}

void write_outputs(const fs::path& folder, const Network& network, const NetworkOptions& options,
                   const std::vector<DrawnScan>& drawn) {
  write_text(folder / "links.csv", links_csv(network));
  write_text(folder / "network.json", report_text(network_json(network, options)));
  write_text(folder / "network.g2o", network_g2o(network));
  write_text(folder / "poses.tum", poses_tum(network));
  write_text(folder / "report.html", network_page(network, options, drawn));
  write_text(folder / "poses.csv", poses_csv(network));
}

// What the answer is for; after the answer itself, which a full disk must not take along.
void write_clouds(const NetworkSettings& settings, const Network& network, const ScanReading& reading,
                  const ProgressCallback& progress) {
  if (network.components.empty() || network.components.front().size() < 2) return;
  if (!settings.moved.empty()) {
    for (const std::string& line : write_moved_scans(settings.moved, network, reading, progress)) {
      if (!settings.quiet) std::cerr << "igsp: warning: " << line << "\n";
    }
  }
  if (!settings.merged.empty()) write_merged(settings.merged, network, reading, progress);
}

int exit_code(const Network& network) {
  const bool all_read =
      std::ranges::all_of(network.scans, [](const NetworkScan& scan) { return scan.problem.empty(); });
  if (!all_read) return exit_input_output;
  return network.components.size() == 1 ? exit_registered : exit_not_registered;
}

// That of an earlier run stays; otherwise the scans are looked at.
void choose_voxel_size(Options& options, NetworkStore& store, Engine& engine, const ScanReading& reading, bool quiet,
                       const ProgressCallback& progress) {
  if (options.scale.voxel_size == 0) options.scale.voxel_size = store.voxel_size();
  if (options.scale.voxel_size == 0) {
    const FirstLook look = look_at_scans(engine, reading, options, progress);
    for (const std::string& warning : look.warnings) {
      if (!quiet) std::cerr << "igsp: warning: " << warning << "\n";
    }
    options.scale.voxel_size = look.voxel_size;
    if (look.voxel_size > 0) store.keep_voxel_size(look.voxel_size);
  }
  store.use_voxel_size(options.scale.voxel_size);
}

int run_network(const NetworkSettings& settings) {
  NetworkOptions options = settings.options;
  options.pair = resolve(*settings.option_flags);
  if (settings.max_points < 1000) {
    throw InvalidArgument(fmt::format("--max-points is {}; it must be at least 1000", settings.max_points));
  }
  const ScanReading reading = reading_of(settings);
  for (const std::string& warning : unusual_values(options.pair)) {
    if (!settings.quiet) std::cerr << "igsp: warning: " << warning << "\n";
  }
  choose_pairs(options, settings.pairs, reading.files);
  choose_world(options, settings, reading.files);
  if (!settings.moved.empty()) check_moved_scans(settings.moved, reading);
  if (!settings.merged.empty()) check_merged(settings.merged);
  const std::unique_ptr<Engine> engine = engine_for(settings, reading);
  make_folder(settings.folder);
  check_writable(settings.folder / "poses.csv");
  ProgressBar bar(!settings.quiet);
  const ProgressCallback progress = bar.callback();
  NetworkStore store(settings.folder / "cache", reading, options.pair, *engine);
  choose_voxel_size(options.pair, store, *engine, reading, settings.quiet, progress);
  if (engine->works_ahead()) store.expect_features(progress);
  options.features_in_memory = held_scans;
  std::vector<DrawnScan> drawn(reading.files.size());
  const auto features = [&](std::size_t i) {
    Features one = store.features(i, progress);
    if (drawn[i].points.empty()) drawn[i] = drawn_scan(one, drawn.size());
    return one;
  };
  Network network = register_network(reading.files.size(), features, options, progress, store.pairs());
  stop_if_interrupted();
  measure_drawn(
      drawn, network, [&](std::size_t i) { return store.features(i, progress); }, options.pair.threads);
  bar.finish();
  for (std::size_t i = 0; i < network.scans.size(); ++i) network.scans[i].name = reading.files[i].string();
  for (const std::string& warning : network.warnings) {
    if (!settings.quiet) std::cerr << "igsp: warning: " << warning << "\n";
  }
  write_outputs(settings.folder, network, options, drawn);
  write_clouds(settings, network, reading, progress);
  bar.finish();
  std::cout << network_summary(network);
  return exit_code(network);
}

// What ends a run of the library is an input's fault to who called the command.
int run_with_engine(const NetworkSettings& settings) {
  try {
    return run_network(settings);
  } catch (const EngineLost& lost) {
    throw FileError(lost.what());
  }
}

constexpr const char* notes =
    "SCANS are files, or folders for all point clouds in them (but .txt and .csv must be named). The folder of -o "
    "gets\n"
    "  poses.csv     scan,component,qw,qx,qy,qz,tx,ty,tz: world_from_scan; every component has a world of its own,\n"
    "                the frame of its first scan (but see --fix, --control); a scan that could not be placed is a "
    "component of its own\n"
    "  links.csv     every pair that was tried: used, unconfirmed (in no loop), rejected or not_registered, and why\n"
    "  report.html   to look at: map, links, stations; one file, without a network\n"
    "  network.json  all of it, with covariances; network.g2o, poses.tum: for other programs\n"
    "  cache         features and pairs: the same command goes on where an earlier one stopped, and scans that are\n"
    "                added are paired with the others only; may be deleted\n"
    "Example:\n"
    "  igsp network scans/*.ply -o survey\n"
    "Exit codes: 0 all scans in one frame, 1 not all, 2 usage or option, 3 a file that cannot be read (the others are\n"
    "registered all the same) or written, 130 interrupted.";

}  // namespace

void add_network_command(CLI::App& app, Command& command) {
  CLI::App* network = app.add_subcommand("network", "put many scans into one frame and say which links to trust");
  const auto settings = std::make_shared<NetworkSettings>();
  network->add_option("SCANS", settings->scans, "files or folders")->required()->type_name("");
  network->add_option("-o,--output", settings->folder, "folder for the answer, made if missing")
      ->required()
      ->type_name("DIR");
  network
      ->add_option("--viewpoints", settings->viewpoints,
                   wrapped("CSV, scan,x,y,z: where scanners stood, each in its scan's own frame; the space that they "
                           "saw through is evidence against wrong links"))
      ->type_name("FILE");
  network
      ->add_option("--write", settings->moved,
                   wrapped("folder for every scan moved into its frame, in its own format with all that belongs to its "
                           "points; those of other frames in component_1, ... in it"))
      ->type_name("DIR");
  network
      ->add_option(
          "--merged", settings->merged,
          wrapped("one cloud of all scans in the largest frame, a point per half voxel: .ply, .pcd or text; in the "
                  "command of the Python package .las and .laz as well"))
      ->type_name("FILE");
  network
      ->add_option("--engine", settings->engine,
                   wrapped("who does the work: local, this process; or dask, the workers of a Dask cluster, which read "
                           "the scans under the same names (in the command of the Python package); default local"))
      ->type_name("local|dask");
  network->add_option("--scheduler", settings->scheduler, "address of the Dask scheduler, such as tcp://HOST:8786")
      ->type_name("ADDRESS");
  network->add_option("--fix", settings->fixed_scan, "scan whose frame is the world; default the first")
      ->type_name("SCAN");
  network
      ->add_option("--control", settings->control,
                   wrapped("CSV, scan,x,y,z,sigma and, where known, qw,qx,qy,qz,sigma_deg: where scanners stood in the "
                           "world, as soft priors with these standard deviations"))
      ->type_name("FILE");
  network->add_flag("--levelled", settings->levelled,
                    wrapped("the scans are levelled: z is up in all of them and in the world; as --dof 4"));
  network
      ->add_option(
          "--pairs", settings->pairs,
          wrapped("which pairs are tried: all; auto, the likeliest first until every scan has enough confirmed "
                  "links or nothing is likely; or a CSV, source,target; default all"))
      ->type_name("all|auto|FILE");
  network
      ->add_option("--min-unconfirmed-confidence", settings->options.min_unconfirmed_confidence,
                   wrapped(fmt::format(
                       "a link in no loop joins scans only with at least this confidence, in [0.5, 1]; default {}",
                       settings->options.min_unconfirmed_confidence)))
      ->type_name("NUMBER");
  network
      ->add_option("--min-unconfirmed-matches", settings->options.min_unconfirmed_matches,
                   wrapped(fmt::format(
                       "... and at least so many agreeing matches, since bare rooms fit each other on few; default {}",
                       settings->options.min_unconfirmed_matches)))
      ->type_name("INTEGER");
  add_read_flags(*network, settings->read);
  network
      ->add_option("--max-points", settings->max_points,
                   wrapped("a cloud with more points is streamed through the voxel filter instead of kept whole; "
                           "default 20000000"))
      ->type_name("INTEGER");
  network->add_flag("--quiet", settings->quiet, "no progress and no warnings, only the answer");
  settings->option_flags = add_option_flags(*network);
  network->footer(notes);
  network->callback([settings, &command] { command = [settings] { return run_with_engine(*settings); }; });
}

}  // namespace igsp::cli
