#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "files/cloud_input.hpp"
#include "files/read_flags.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/progress_bar.hpp"
#include "spatial/point_grid.hpp"
#include "spatial/unit_of_length.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kept_points = 20'000'000;

// Median distance to the nearest other point, over a sample.
double spacing_of(PointView cloud, const Bounds& bounds, double voxel_size) {
  const Eigen::Vector3d origin = centre_of(bounds);
  const double unit = unit_of_length(bounds, bounds, voxel_size);
  Points local(cloud.begin(), cloud.end());
  for (Eigen::Vector3d& point : local) point = (point - origin) / unit;
  const PointGrid grid(local, voxel_size / unit);
  std::vector<float> distances;
  const std::size_t stride = std::max<std::size_t>(1, local.size() / 2000);
  for (std::size_t i = 0; i < local.size(); i += stride) {
    float nearest = INFINITY;
    for (double radius = voxel_size / unit; !std::isfinite(nearest); radius *= 2.0) {
      grid.visit_sphere(local[i].cast<float>(), static_cast<float>(radius), [&](std::uint32_t j, float squared) {
        if (grid.index[j] != i) nearest = std::min(nearest, squared);
      });
    }
    distances.push_back(std::sqrt(nearest));
  }
  std::ranges::nth_element(distances, distances.begin() + distances.size() / 2);
  return unit * distances[distances.size() / 2];
}

std::string place_text(const Eigen::Vector3d& place) {
  return fmt::format("at {:.10g}", fmt::join(place.begin(), place.end(), " "));
}

std::string viewpoint_text(const ViewpointFinding& found) {
  return found.viewpoint ? place_text(*found.viewpoint) + ": " + found.reason : found.reason;
}

void print_parts(const CloudInput& cloud) {
  for (std::size_t i = 0; i < cloud.parts.size(); ++i) {
    const std::optional<Eigen::Vector3d>& place = cloud.viewpoint.parts[i].viewpoint;
    std::cout << fmt::format("    scan {:<15}{} points, scanner {}\n", i, cloud.parts[i].total,
                             place ? place_text(*place) : "unknown");
  }
}

void print_info(const CloudInput& cloud) {
  const Eigen::Vector3d extent = cloud.bounds.max - cloud.bounds.min;
  const double magnitude = cloud.bounds.min.cwiseAbs().cwiseMax(cloud.bounds.max.cwiseAbs()).maxCoeff();
  const double voxel_size = choose_voxel_size(cloud.points, cloud.points, {});
  const double spacing = spacing_of(cloud.points, cloud.bounds, voxel_size);
  std::cout << cloud.path.string() << "\n";
  std::cout << fmt::format("  format                {}\n", cloud.format);
  std::cout << fmt::format("  points                {}{}\n", cloud.total,
                           cloud.dropped > 0 ? fmt::format(" and {} dropped, not finite", cloud.dropped) : "");
  if (cloud.noise > 0) {
    std::cout << fmt::format("  left out              {} classified as noise (7, 18) or withheld\n", cloud.noise);
  }
  std::cout << fmt::format("  extent                {:.6g} x {:.6g} x {:.6g}\n", extent.x(), extent.y(), extent.z());
  std::cout << fmt::format("  from                  {:.10g}\n",
                           fmt::join(cloud.bounds.min.data(), cloud.bounds.min.data() + 3, " "));
  std::cout << fmt::format("  to                    {:.10g}\n",
                           fmt::join(cloud.bounds.max.data(), cloud.bounds.max.data() + 3, " "));
  std::cout << fmt::format("  largest coordinate    {:.10g} (as float: exact to {:.2g})\n", magnitude,
                           std::ldexp(magnitude, -24));
  std::cout << fmt::format("  spacing               {:.4g}{}\n", spacing,
                           cloud.whole() ? "" : " (of the points kept in memory)");
  std::cout << fmt::format("  scanner               {}\n", viewpoint_text(cloud.viewpoint));
  print_parts(cloud);
  std::cout << fmt::format("  suggested voxel size  {:.4g}\n", voxel_size);
}

struct InfoSettings {
  std::vector<fs::path> paths;
  ReadOptions read;
};

int run_info(const InfoSettings& settings) {
  for (const fs::path& path : settings.paths) {
    ProgressBar bar(true);
    CloudInput cloud = read_cloud(path, kept_points, "read", bar.callback(), settings.read);
    bar.finish();
    settle_viewpoint(cloud, {});
    print_info(cloud);
  }
  return exit_registered;
}

}  // namespace

void add_info_command(CLI::App& app, Command& command) {
  CLI::App* info = app.add_subcommand("info", "what a point cloud file holds, and the voxel size that suits it");
  const auto settings = std::make_shared<InfoSettings>();
  info->add_option("FILE", settings->paths, "PLY, PCD, LAS or text (XYZ, TXT, CSV, PTS)")->required()->type_name("");
  add_read_flags(*info, settings->read);
  info->footer(
      "Example:\n  igsp info scan.ply\n"
      "The voxel size of a pair, one for both clouds, is chosen and printed by `igsp align`.");
  info->callback([settings, &command] { command = [settings] { return run_info(*settings); }; });
}

}  // namespace igsp::cli
