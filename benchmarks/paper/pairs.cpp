#include "pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "benchmark/cases.hpp"
#include "benchmark/judgement.hpp"
#include "files/csv.hpp"
#include "files/output_file.hpp"
#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "igsp/simulation.hpp"
#include "simulation/overlap.hpp"
#include "spatial/scale.hpp"

namespace igsp::paper {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t scramble_seed = 7;

struct NamedScans {
  const char* dataset;
  const char* name;
};
constexpr std::array<NamedScans, 12> real_pairs{{{"Stanford", "bunny/bun270--bun000"},
                                                 {"Stanford", "bunny/bun180--bun090"},
                                                 {"Stanford", "bunny/bun315--top3"},
                                                 {"Stanford", "bunny/top2--bun270"},
                                                 {"Stanford 80 %", "bunny/bun045--bun000"},
                                                 {"Stanford 80 %", "bunny/bun315--bun000"},
                                                 {"Stanford 80 %", "bunny/top2--bun180"},
                                                 {"Stanford 80 %", "bunny/ear-back--bun180"},
                                                 {"Facade", "facade/s4--s2"},
                                                 {"Facade", "facade/s5--s3"},
                                                 {"Facade", "facade/s6--s3"},
                                                 {"Facade", "facade/s5--s4"}}};

struct SimulatedScene {
  const char* dataset;
  const char* scene;
  double overlap;         // wanted, of points with a neighbour ...
  double overlap_radius;  // ... nearer than this [m]: two of our voxels, yet the pairs shall not change with the method
  double station_distance;  // [m]
  double max_displacement;  // [m]
};
// At these distances several seeds of a hundred have the wanted overlap.
constexpr std::array<SimulatedScene, 2> scenes{
    {{"Park", "park", 0.65, 0.65, 14.0, 0.3}, {"Indoor", "indoor", 0.70, 0.20, 4.0, 0.1}}};
constexpr int pairs_per_scene = 4, points_per_scan = 60000;
constexpr double overlap_tolerance = 0.03;

class PairWriter {
 public:
  explicit PairWriter(fs::path folder) : folder_(std::move(folder)) { fs::create_directories(folder_); }

  void add(const Pair& pair, double overlap, const std::string& origin) {
    Bounds bounds = bounds_of(pair.source, "source");
    const Transformation motion = cli::scramble(scramble_seed, pair.name, centre_of(bounds), bounds.diagonal());
    Points source;
    for (const Eigen::Vector3d& point : pair.source) source.push_back(motion * point);
    std::string file = pair.name;
    std::replace(file.begin(), file.end(), '/', '_');
    const WriteOptions as_floats{.format = FileFormat::ply_binary_little_endian, .single_precision = true};
    write_points(folder_ / (file + "_source.ply"), source, as_floats);
    write_points(folder_ / (file + "_target.ply"), pair.target, as_floats);
    write_transformation(folder_ / (file + ".txt"), pair.truth * motion.inverse());
    rows_ += fmt::format("{0},{1},{2}_source.ply,{2}_target.ply,{2}.txt,{3},{4},{5:.2f},{6},{7},{8}\n", pair.name,
                         pair.dataset, file, pair.max_rotation_error_deg, pair.max_displacement, overlap, source.size(),
                         pair.target.size(), origin);
    std::cerr << fmt::format("{}: overlap {:.2f}\n", pair.name, overlap);
  }

  void finish() const {
    cli::write_text(folder_ / "cases.csv",
                    "name,group,source,target,truth,max_rotation_error_deg,max_translation_error_m,overlap,"
                    "source_points,target_points,origin\n" +
                        rows_);
  }

 private:
  fs::path folder_;
  std::string rows_;
};

double overlap_of(const Pair& pair, double radius) {
  SimulatedScan source{pair.source, pair.truth}, target{pair.target, Transformation::Identity()};
  return std::min(simulation::overlap_of(source, target, radius), simulation::overlap_of(target, source, radius));
}

void add_simulated(const SimulatedScene& scene, PairWriter& writer) {
  int found = 0;
  for (std::uint64_t seed = 1; found < pairs_per_scene; ++seed) {
    if (seed > 100) throw InvalidArgument(fmt::format("{}: no overlap of {} in 100 seeds", scene.scene, scene.overlap));
    SimulationOptions options;
    options.points = points_per_scan;
    options.station_distance = scene.station_distance;
    options.seed = seed;
    std::vector<SimulatedScan> scans = simulate(scene.scene, options);
    Pair pair{fmt::format("{}/{}", scene.scene, seed),
              scene.dataset,
              std::move(scans[1].points),
              std::move(scans[0].points),
              scans[0].world_from_scanner.inverse() * scans[1].world_from_scanner,
              2.0,
              scene.max_displacement};
    const double overlap = overlap_of(pair, scene.overlap_radius);
    if (std::abs(overlap - scene.overlap) > overlap_tolerance) continue;
    writer.add(pair, overlap,
               fmt::format("igsp simulate {} --points {} --station-distance {} --seed {}", scene.scene, points_per_scan,
                           scene.station_distance, seed));
    ++found;
  }
}

void add_real(const fs::path& scans, PairWriter& writer) {
  const cli::CsvTable table = cli::read_csv(scans / "cases.csv");
  const std::vector<cli::BenchmarkCase> cases = cli::read_cases(scans / "cases.csv");
  const auto overlap_column = cli::find_column(table, "overlap");
  for (const NamedScans& wanted : real_pairs) {
    const auto one = std::find_if(cases.begin(), cases.end(), [&](const auto& c) { return c.name == wanted.name; });
    if (one == cases.end() || !overlap_column) {
      throw FileError(fmt::format("{}: no case {} with its overlap", table.path.string(), wanted.name));
    }
    const Pair pair{wanted.name,
                    wanted.dataset,
                    read_points(one->source).points,
                    read_points(one->target).points,
                    read_transformation(one->truth_file),
                    one->max_rotation_error_deg,
                    one->max_displacement};
    const auto& fields = table.records[static_cast<std::size_t>(one - cases.begin())].fields;
    writer.add(pair, std::stod(fields[*overlap_column]), wanted.name);
  }
}

}  // namespace

void write_pairs(const fs::path& scans, const fs::path& folder) {
  PairWriter writer(folder);
  if (fs::exists(scans / "cases.csv")) {
    add_real(scans, writer);
  } else {
    std::cerr << fmt::format("{} is not there: Stanford and Facade are left out\n", (scans / "cases.csv").string());
  }
  for (const SimulatedScene& scene : scenes) add_simulated(scene, writer);
  writer.finish();
}

std::vector<Pair> read_pairs(const fs::path& folder) {
  std::vector<Pair> pairs;
  for (const cli::BenchmarkCase& one : cli::read_cases(folder / "cases.csv")) {
    pairs.push_back({one.name, one.group, read_points(one.source).points, read_points(one.target).points,
                     read_transformation(one.truth_file), one.max_rotation_error_deg, one.max_displacement});
  }
  return pairs;
}

}  // namespace igsp::paper
