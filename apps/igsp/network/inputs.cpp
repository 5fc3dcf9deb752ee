#include "network/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

#include "files/cloud_input.hpp"
#include "files/csv.hpp"
#include "files/foreign_formats.hpp"
#include "igsp/errors.hpp"
#include "network/common_scale.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

// Not .txt and .csv: in a folder of scans these are as a rule something else. They can be named one by one.
bool is_cloud(const fs::path& path) {
  static const std::set<std::string> extensions = {".ply", ".pcd", ".xyz", ".pts", ".asc",
                                                   ".las", ".laz", ".e57", ".ptx"};
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extensions.contains(extension);
}

std::vector<fs::path> clouds_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file() && is_cloud(entry.path())) files.push_back(entry.path());
  }
  if (error) throw FileError(fmt::format("{}: cannot be listed: {}", folder.string(), error.message()));
  if (files.empty()) throw FileError(fmt::format("{}: a folder without any point cloud", folder.string()));
  std::ranges::sort(files);
  return files;
}

double number_in(const CsvTable& table, const CsvRecord& record, std::size_t column) {
  const std::string& text = record.fields[column];
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) {
    fail_at(table, record, column, fmt::format("\"{}\" is not a finite number", text));
  }
  return number;
}

std::size_t required_column(const CsvTable& table, std::string_view name, std::string_view all) {
  const std::optional<std::size_t> column = find_column(table, name);
  if (!column) throw FileError(fmt::format("{}: has no column {}; {} are needed", table.path.string(), name, all));
  return *column;
}

std::optional<std::size_t> find_scan(const std::string& name, const std::vector<fs::path>& files) {
  auto found = std::ranges::find(files, fs::path(name));
  if (found == files.end()) {
    found =
        std::ranges::find_if(files, [&](const auto& file) { return file.filename() == name || file.stem() == name; });
  }
  if (found == files.end()) return {};
  return found - files.begin();
}

// The scan that a field names.
std::size_t scan_in(const CsvTable& table, const CsvRecord& record, std::size_t column,
                    const std::vector<fs::path>& files) {
  const std::string& name = record.fields[column];
  const std::optional<std::size_t> scan = find_scan(name, files);
  if (!scan) fail_at(table, record, column, fmt::format("\"{}\" is none of the scans given", name));
  return *scan;
}

double positive_in(const CsvTable& table, const CsvRecord& record, std::size_t column) {
  const double number = number_in(table, record, column);
  if (number <= 0) fail_at(table, record, column, fmt::format("{} is not greater than 0", number));
  return number;
}

}  // namespace

std::vector<fs::path> scan_files(const std::vector<fs::path>& given) {
  std::vector<fs::path> files;
  for (const fs::path& path : given) {
    std::error_code ignored;
    const std::vector<fs::path> inside =
        fs::is_directory(path, ignored) ? clouds_in(path) : std::vector<fs::path>{path};
    files.insert(files.end(), inside.begin(), inside.end());
  }
  std::set<fs::path> seen;
  for (const fs::path& file : files) {
    if (!seen.insert(file.lexically_normal()).second) {
      throw InvalidArgument(fmt::format("{} is given twice", file.string()));
    }
  }
  std::vector<fs::path> scans;
  for (const fs::path& file : files) {
    const std::vector<fs::path> inside = scans_in(file);
    scans.insert(scans.end(), inside.begin(), inside.end());
  }
  return scans;
}

std::map<fs::path, Eigen::Vector3d> read_viewpoints(const fs::path& path, const std::vector<fs::path>& files) {
  const CsvTable table = read_csv(path);
  const auto column = [&](std::string_view name) { return required_column(table, name, "scan,x,y,z"); };
  const std::size_t scan = column("scan"), x = column("x"), y = column("y"), z = column("z");
  std::map<fs::path, Eigen::Vector3d> viewpoints;
  for (const CsvRecord& record : table.records) {
    const fs::path& file = files[scan_in(table, record, scan, files)];
    viewpoints[file] = {number_in(table, record, x), number_in(table, record, y), number_in(table, record, z)};
  }
  return viewpoints;
}

std::vector<ScanPair> read_pairs(const fs::path& path, const std::vector<fs::path>& files) {
  const CsvTable table = read_csv(path);
  const std::size_t source = required_column(table, "source", "source,target"),
                    target = required_column(table, "target", "source,target");
  std::vector<ScanPair> pairs;
  for (const CsvRecord& record : table.records) {
    pairs.emplace_back(scan_in(table, record, source, files), scan_in(table, record, target, files));
    if (pairs.back().first == pairs.back().second) fail_at(table, record, target, "the scan is paired with itself");
  }
  return pairs;
}

std::size_t scan_named(const std::string& name, const std::vector<fs::path>& files, std::string_view option) {
  const std::optional<std::size_t> scan = find_scan(name, files);
  if (!scan) throw InvalidArgument(fmt::format("{} {}: none of the scans given", option, name));
  return *scan;
}

std::vector<ControlPose> read_control(const fs::path& path, const std::vector<fs::path>& files) {
  constexpr std::string_view position = "scan,x,y,z,sigma", rotation = "qw,qx,qy,qz,sigma_deg";
  const CsvTable table = read_csv(path);
  const auto column = [&](std::string_view name) { return required_column(table, name, position); };
  const auto turn = [&](std::string_view name) { return required_column(table, name, rotation); };
  const std::size_t scan = column("scan"), x = column("x"), y = column("y"), z = column("z"), sigma = column("sigma");
  const bool has_rotations = find_column(table, "qw").has_value();
  std::vector<ControlPose> control;
  for (const CsvRecord& record : table.records) {
    const auto number = [&](std::size_t c) { return number_in(table, record, c); };
    ControlPose& one = control.emplace_back();
    one.scan = scan_in(table, record, scan, files);
    one.position = {number(x), number(y), number(z)};
    one.position_sigma = positive_in(table, record, sigma);
    if (!has_rotations || record.fields[turn("qw")].empty()) continue;
    const Eigen::Quaterniond q(number(turn("qw")), number(turn("qx")), number(turn("qy")), number(turn("qz")));
    if (!(std::abs(q.norm() - 1) < 1e-3)) fail_at(table, record, turn("qw"), "the quaternion is not of unit length");
    one.rotation = q.normalized();
    one.rotation_sigma_rad = positive_in(table, record, turn("sigma_deg")) * std::numbers::pi / 180;
  }
  return control;
}

ScanLook look_at_scan(const ScanReading& reading, std::size_t scan, const ScaleOptions& scale,
                      const ProgressCallback& progress) {
  const std::string stage = fmt::format("look at {} of {}", scan + 1, reading.files.size());
  const CloudInput cloud = read_cloud(reading.files[scan], reading.max_points, stage, progress, reading.read);
  return {own_voxel_size(cloud.points, scale), cloud.bounds.diagonal()};
}

Features read_features(const ScanReading& reading, std::size_t scan, const Options& options,
                       const ProgressCallback& progress) {
  const fs::path& file = reading.files[scan];
  const std::string stage = fmt::format("scan {} of {}", scan + 1, reading.files.size());
  CloudInput cloud = read_cloud(file, reading.max_points, stage, progress, reading.read);
  const auto given = reading.viewpoints.find(file);
  settle_viewpoint(cloud, {});
  if (given != reading.viewpoints.end()) cloud.viewpoint = {given->second, "given", ""};
  if (!cloud.whole()) take_centroids(cloud, options.scale.voxel_size / 4, stage, progress);
  Features features = extract_features(cloud.scan(), options);
  features.cloud_points = cloud.total;
  return features;
}

}  // namespace igsp::cli
