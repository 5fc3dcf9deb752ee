// The registrations of the Point Cloud Library, run once on two files.
//
//   pcl_peer METHOD SOURCE TARGET --voxel-size V [--seed N] [--threads N] [--overlap O] [--time-limit S]
//
// METHOD is one of
//   icp                    point-to-point ICP from aligned centroids, or with --as-given from where the clouds lie
//   ndt                    3D-NDT, the same
//   prerejective           FPFH, SampleConsensusPrerejective
//   geometric_consistency  FPFH, mutual nearest neighbours, GeometricConsistencyGrouping
//   kfpcs                  ISS keypoints, KFPCSInitialAlignment
// All but the first two are followed by point-to-plane ICP, which is a second answer. One JSON object goes to standard
// output: the version of PCL, the peak of the memory before the registration, and per answer its seconds, a label (""
// or "icp"), target_from_source (4x4, rows), whether PCL says that it converged, and a score. The seconds are those of
// the registration from points in memory, all threads together for the CPU; the second answer's include the first's.
// Lengths that PCL wants are multiples of the voxel size V. Exit code: 0 whatever the answer, 2 for a wrong option, 3
// for a file.
#include <pcl/pcl_config.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>

#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "pcl_methods.hpp"

namespace {

using namespace igsp::peers;

struct Seconds {
  double wall, cpu;

  static Seconds now() {
    timespec cpu{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
    return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
            static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec)};
  }
};

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

Eigen::Vector3d centroid_of(const igsp::Points& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point - points.front();
  return points.front() + sum / static_cast<double>(points.size());
}

// PCL computes in floats: about the centroid nothing is lost.
Cloud::Ptr centred(const igsp::Points& points, const Eigen::Vector3d& centroid) {
  Cloud::Ptr cloud(new Cloud);
  cloud->reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3f p = (point - centroid).cast<float>();
    cloud->push_back({p.x(), p.y(), p.z()});
  }
  return cloud;
}

nlohmann::json to_json(const Answer& answer, const Eigen::Vector3d& source_centroid,
                       const Eigen::Vector3d& target_centroid, const Seconds& spent) {
  // Back from the centred frames; the rotation is made exact again after the floats.
  const Eigen::Matrix4d centred = answer.target_from_source.cast<double>();
  const Eigen::Matrix3d rotation =
      Eigen::Quaterniond(Eigen::Matrix3d(centred.topLeftCorner<3, 3>())).normalized().matrix();
  const Eigen::Vector3d translation = centred.topRightCorner<3, 1>() + target_centroid - rotation * source_centroid;
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({rotation(i, 0), rotation(i, 1), rotation(i, 2), translation(i)});
  rows.push_back({0, 0, 0, 1});
  return {{"label", answer.label}, {"target_from_source", rows}, {"converged", answer.converged},
          {"score", answer.score}, {"cpu_seconds", spent.cpu},   {"wall_seconds", spent.wall}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A registration of the Point Cloud Library, run once on two files; the answer is JSON.");
  std::string method, source_path, target_path;
  Settings settings;
  unsigned seed = 0;
  bool as_given = false;
  app.add_option("METHOD", method)->required()->check(CLI::IsMember(method_names()));
  app.add_option("SOURCE", source_path)->required();
  app.add_option("TARGET", target_path)->required();
  app.add_option("--voxel-size", settings.voxel_size)->required()->check(CLI::PositiveNumber);
  app.add_option("--seed", seed, "of rand(); kfpcs takes the clock instead, whatever is given");
  app.add_option("--threads", settings.threads)->check(CLI::PositiveNumber);
  app.add_option("--overlap", settings.overlap, "what kfpcs is told; default 0.5, as in PCL");
  app.add_flag("--as-given", as_given, "start from where the clouds lie, not from aligned centroids");
  app.add_option("--time-limit", settings.time_limit_s, "of kfpcs, by the clock [s]; default 60");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const igsp::Points source = igsp::read_points(source_path).points, target = igsp::read_points(target_path).points;
    if (source.empty() || target.empty()) throw igsp::FileError("a cloud without points");
    const Eigen::Vector3d target_centroid = centroid_of(target);
    const Eigen::Vector3d source_centroid = as_given ? target_centroid : centroid_of(source);
    const Cloud::Ptr moving = centred(source, source_centroid), fixed = centred(target, target_centroid);
    std::srand(seed);
    nlohmann::json answers = nlohmann::json::array();
    const std::size_t memory_before = peak_memory_bytes();
    const Seconds start = Seconds::now();
    register_clouds(method, moving, fixed, settings, [&](const Answer& answer) {
      const Seconds now = Seconds::now();
      answers.push_back(
          to_json(answer, source_centroid, target_centroid, {now.wall - start.wall, now.cpu - start.cpu}));
    });
    const nlohmann::json report = {
        {"version", PCL_VERSION_PRETTY}, {"memory_before_bytes", memory_before}, {"answers", answers}};
    std::cout << report.dump() << "\n";
  } catch (const std::exception& error) {
    std::cerr << "pcl_peer: " << error.what() << "\n";
    return 3;
  }
}
