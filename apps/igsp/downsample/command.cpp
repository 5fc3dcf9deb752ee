#include <fmt/format.h>

#include <cmath>
#include <iostream>

#include "downsample/voxels.hpp"
#include "files/cloud_to_cloud.hpp"
#include "files/foreign_formats.hpp"
#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/progress_bar.hpp"

namespace igsp::cli {
namespace {

struct DownsampleSettings {
  CloudToCloud clouds;
  double voxel_size = 0.0;
};

bool floats_are_exact(PointView points, double tolerance) {
  double largest = 0.0;
  for (const Eigen::Vector3d& point : points) largest = std::max(largest, point.cwiseAbs().maxCoeff());
  return std::ldexp(largest, -24) <= tolerance;
}

int run_downsample(const DownsampleSettings& settings) {
  const CloudToCloud& clouds = settings.clouds;
  const double voxel_size = settings.voxel_size;
  if (!(voxel_size > 0.0) || !std::isfinite(voxel_size)) {
    throw InvalidArgument(fmt::format("--voxel-size is {}; it must be positive and finite", voxel_size));
  }
  check_not_foreign(clouds.output);
  format_of(clouds.output);
  check_cloud_to_cloud(clouds);
  ProgressBar bar(!clouds.quiet);
  CloudInput thinned = voxels_of(clouds.source, voxel_size, bar.callback(), clouds.read);
  bar.finish();
  print_left_out(clouds, thinned);
  write_points(clouds.output, thinned.points,
               {.single_precision = floats_are_exact(thinned.points, 1e-4 * voxel_size),
                .viewpoint = thinned.declared_viewpoint});
  std::cout << fmt::format("{} points in {} voxels of {:.6g}\n", thinned.total, thinned.points.size(), voxel_size);
  return exit_registered;
}

constexpr const char* examples =
    "Example:\n"
    "  igsp downsample scan.ply --voxel-size 0.05 -o thin.ply\n"
    "One pass, in memory that grows with the voxels alone (a second one for coordinates beyond 2^20 voxels from the\n"
    "origin). The centroids are exact sums: the same bits for any order of the points. They are written sorted, and\n"
    "are x, y and z only.";

}  // namespace

void add_downsample_command(CLI::App& app, Command& command) {
  CLI::App* downsample = app.add_subcommand("downsample", "one point a voxel: the centroid of those that lie in it");
  const auto settings = std::make_shared<DownsampleSettings>();
  add_cloud_to_cloud_flags(*downsample, settings->clouds, "the centroids: PLY, PCD or text");
  downsample->add_option("--voxel-size", settings->voxel_size, "edge of a voxel, in the unit of the cloud")
      ->required()
      ->type_name("NUMBER");
  downsample->footer(examples);
  downsample->callback([settings, &command] { command = [settings] { return run_downsample(*settings); }; });
}

}  // namespace igsp::cli
