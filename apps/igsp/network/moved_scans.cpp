#include "network/moved_scans.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/report_progress.hpp"
#include "files/cloud_file.hpp"
#include "files/foreign_formats.hpp"
#include "files/moved_output.hpp"
#include "files/output_file.hpp"
#include "igsp/errors.hpp"
#include "io/file_format.hpp"
#include "spatial/voxel_grid.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t sample_size = 1000;  // of a scan whose points are only passed on

constexpr double tolerance = 1e-4;  // [voxels]: floats are written where they are as exact

// FILE#1 of the file as it has been written so far: its other scans stay as they are.
fs::path scan_of(const fs::path& file, const fs::path& scan) {
  const std::string name = scan.string();
  return file.string() + name.substr(file_of_scan(scan).string().size());
}

// By scan; empty for one that lies alone.
std::vector<fs::path> moved_files(const fs::path& folder, const Network& network, const ScanReading& reading) {
  std::vector<fs::path> outputs(reading.files.size());
  std::map<fs::path, fs::path> output_of;  // by the file that is read
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::size_t component = network.scans[i].component;
    if (network.components[component].size() < 2) continue;
    const fs::path file = file_of_scan(reading.files[i]);
    const fs::path place = component == 0 ? folder : folder / fmt::format("component_{}", component);
    outputs[i] = output_of.emplace(file, place / file.filename()).first->second;
  }
  return outputs;
}

// What write_moved_output needs to know of a scan. A PCD with the default VIEWPOINT is looked at whole, since where its
// scanner stood may be told by its points alone.
CloudInput look_at(const fs::path& scan, const fs::path& output, const ScanReading& reading,
                   const std::optional<Eigen::Vector3d>& viewpoint) {
  CloudInput cloud;
  cloud.path = scan;
  if (moves_foreign(scan, output) || moves_las(scan, output)) return cloud;
  const bool is_pcd = io::extension_of(scan) == ".pcd";
  cloud = sample_cloud(scan, is_pcd && !viewpoint ? reading.max_points : sample_size, "write", {}, reading.read);
  if (is_pcd && !viewpoint && !cloud.points.empty()) settle_viewpoint(cloud, {});
  if (viewpoint) cloud.viewpoint.viewpoint = viewpoint;
  return cloud;
}

std::optional<Eigen::Vector3d> given_viewpoint(const ScanReading& reading, const fs::path& scan) {
  const auto given = reading.viewpoints.find(scan);
  if (given == reading.viewpoints.end()) return {};
  return given->second;
}

// Fine beside the spacing, and of numbers that a reader of the header takes in: a power of ten and a multiple of it.
CoordinateGrid grid_about(const Eigen::Vector3d& origin, double spacing) {
  constexpr double finest = 2000, round_offset = 1000;  // the spacing in steps, and the offset's multiple
  static_assert(VoxelFilter::reach * finest + round_offset < std::numeric_limits<std::int32_t>::max());
  const double scale = std::pow(10.0, std::ceil(std::log10(spacing / finest)));
  const double multiple = round_offset * scale;
  return {(origin / multiple).array().round() * multiple, scale};
}

ChunkSource chunks_of(const Points& points) {
  return [&points, begin = std::size_t{0}]() mutable {
    const std::size_t size = std::min(PointReader::default_chunk, points.size() - begin);
    return PointView(points).subspan(std::exchange(begin, begin + size), size);
  };
}

}  // namespace

void check_moved_scans(const fs::path& folder, const ScanReading& reading) {
  std::map<fs::path, fs::path> file_named;
  for (const fs::path& scan : reading.files) {
    const fs::path file = file_of_scan(scan);
    const auto& [name, first] = *file_named.emplace(file.filename(), file).first;
    if (first != file) {
      throw InvalidArgument(fmt::format("--write: {} and {} would be written under one name; rename one of them",
                                        first.string(), file.string()));
    }
    std::error_code ignored;
    if (fs::equivalent(file, folder / name, ignored)) {
      throw InvalidArgument(fmt::format("--write: {} would be overwritten; choose another folder", file.string()));
    }
  }
}

std::vector<std::string> write_moved_scans(const fs::path& folder, const Network& network, const ScanReading& reading,
                                           const ProgressCallback& progress) {
  const std::vector<fs::path> outputs = moved_files(folder, network, reading);
  std::set<fs::path> begun;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    report_progress(progress, "write", i, outputs.size());
    if (outputs[i].empty()) continue;
    make_folder(outputs[i].parent_path());
    const bool is_first = begun.insert(outputs[i]).second;
    const fs::path source = is_first ? reading.files[i] : scan_of(outputs[i], reading.files[i]);
    check_moved_output(source, outputs[i]);
    const CloudInput cloud = look_at(source, outputs[i], reading, given_viewpoint(reading, reading.files[i]));
    const auto quiet = [&](const Progress&) {
      report_progress(progress, "write", i, outputs.size());
      return true;
    };
    for (std::string& line : write_moved_output(cloud, outputs[i], network.scans[i].world_from_scan,
                                                tolerance * network.voxel_size, quiet)) {
      lines.push_back(std::move(line));
    }
  }
  report_progress(progress, "write", 1, 1);
  return lines;
}

void check_merged(const fs::path& path) {
  if (!writes_foreign_points(path)) {
    const std::string extension = io::extension_of(path);
    if (extension == ".las" || extension == ".laz") {
      throw FileError(fmt::format(
          "--merged {}: {} is written by the same command from pip install 'igsp[las]'; this one writes .ply, .pcd "
          "and text",
          path.string(), extension));
    }
    format_of(path);
  }
  check_writable(path);
}

std::size_t write_merged(const fs::path& path, const Network& network, const ScanReading& reading,
                         const ProgressCallback& progress) {
  const double spacing = network.voxel_size / 2;
  const std::vector<std::size_t>& scans = network.components.front();
  const Eigen::Vector3d origin = network.scans[scans.front()].centre;
  VoxelFilter filter(origin, spacing);
  const double reach = 0.99 * VoxelFilter::reach * spacing;  // stray points beyond it are left out
  Points moved;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const Transformation& world_from_scan = network.scans[scans[k]].world_from_scan;
    CloudFile reader(reading.files[scans[k]], reading.read);
    for (PointView chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
      report_progress(progress, "merge", k, scans.size());
      moved.clear();
      for (const Eigen::Vector3d& point : chunk) {
        const Eigen::Vector3d in_world = world_from_scan * point;
        if ((in_world - origin).cwiseAbs().maxCoeff() < reach) moved.push_back(in_world);
      }
      filter.add(moved);
    }
  }
  Points centroids = filter.centroids();
  for (Eigen::Vector3d& centroid : centroids) centroid += origin;
  if (writes_foreign_points(path)) {
    write_foreign_points(path, chunks_of(centroids), grid_about(origin, spacing));
  } else {
    write_points(path, centroids);
  }
  report_progress(progress, "merge", 1, 1);
  return centroids.size();
}

}  // namespace igsp::cli
