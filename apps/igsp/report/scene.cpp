#include "report/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.hpp"
#include "report/seen_through.hpp"
#include "shell/interrupt.hpp"
#include "spatial/local_pca.hpp"
#include "spatial/point_grid.hpp"
#include "spatial/trimmed_scan.hpp"

namespace igsp::cli {
namespace {

constexpr std::size_t max_drawn_points = 150'000;   // of a cloud
constexpr std::size_t max_scene_bytes = 8'000'000;  // before base64: the page stays below 15 MB
constexpr std::size_t point_bytes = 9;              // three coordinates of 16 bits, a normal of three times 8
constexpr double reach_in_voxels = 2.5;             // as far as matches may be apart to agree
constexpr std::uint8_t out_of_reach = 255;

struct LocalCloud {
  Points points;                // relative to the origin
  std::vector<ScanPart> parts;  // where a viewpoint is known; one, if it is one scan
  Eigen::Vector3d origin;
  Bounds bounds;  // of the points that are drawn
};

LocalCloud localised(const Scan& scan, std::string_view name) {
  LocalCloud local;
  const TrimmedScan trimmed(scan, name);
  local.origin = centre_of(trimmed.cloud.bounds());
  local.points.assign(trimmed.cloud.points().begin(), trimmed.cloud.points().end());
  for (Eigen::Vector3d& point : local.points) point -= local.origin;
  local.parts = trimmed.parts;
  local.bounds = bounds_of(local.points, name);
  return local;
}

// One point at a quasi-random place of every stretch of the file: every n-th would draw stripes of a scan's rows.
Points thinned(const Points& points, std::size_t count) {
  if (points.size() <= count) return points;
  const double stretch = static_cast<double>(points.size()) / static_cast<double>(count);
  Points kept;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0);
    const auto index = static_cast<std::size_t>((static_cast<double>(i) + place) * stretch);
    kept.push_back(points[std::min(index, points.size() - 1)]);
  }
  return kept;
}

Json numbers(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

// For the shading alone: of the drawn points, three times an int8.
std::string normals_of(const Points& drawn, double radius, int threads) {
  const LocalPca pca = local_pca(PointGrid(drawn, radius / 2.0), radius, threads);
  std::vector<std::uint8_t> bytes;
  for (const Eigen::Vector3f& normal : pca.normals) {
    for (const float part : normal) bytes.push_back(static_cast<std::uint8_t>(std::lround(127.0f * part)));
  }
  return base64(bytes);
}

Json drawn_cloud(const LocalCloud& cloud, const Points& drawn, double voxel_size, int threads) {
  const Eigen::Vector3d extent = cloud.bounds.max - cloud.bounds.min;
  const Eigen::Vector3d scale = extent.unaryExpr([](double length) { return length > 0.0 ? 65535.0 / length : 0.0; });
  std::vector<std::uint8_t> bytes;
  for (const Eigen::Vector3d& point : drawn) {
    const Eigen::Vector3d steps = (point - cloud.bounds.min).cwiseProduct(scale);
    for (const double step : steps) {
      const auto value = static_cast<std::uint16_t>(std::lround(step));
      bytes.push_back(value & 255);
      bytes.push_back(value >> 8);
    }
  }
  return {{"drawn", drawn.size()},
          {"known", cloud.points.size()},
          {"origin", numbers(cloud.origin)},
          {"min", numbers(cloud.bounds.min)},
          {"extent", numbers(extent)},
          {"coordinates", base64(bytes)},
          {"normals", normals_of(drawn, voxel_size, threads)}};
}

struct Pose {
  std::string kind;  // "given", "iteration", "final", "runner_up"
  int k = 0;         // of an iteration
  Transformation target_from_source = Transformation::Identity();
};

Transformation pose_of(const Json& rows) {
  Transformation pose = Transformation::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) pose.matrix()(i, j) = rows[i][j].get<double>();
  }
  return pose;
}

std::vector<Pose> poses_of(const Json& run) {
  std::vector<Pose> poses = {{.kind = "given"}};
  for (const Json& record : run["iterations"]) {
    poses.push_back({"iteration", record["k"].get<int>(), pose_of(record["target_from_source"])});
  }
  if (!run["target_from_source"].is_null()) poses.push_back({"final", 0, pose_of(run["target_from_source"])});
  if (!run["runner_up"].is_null()) {
    poses.push_back({"runner_up", 0, pose_of(run["runner_up"]["target_from_source"])});
  }
  return poses;
}

// To the nearest target point, 0 to 254 in 254ths of the reach.
std::vector<std::uint8_t> distances(const Points& drawn, const LocalCloud& target, const PointGrid& grid,
                                    const Transformation& place, double reach, int threads) {
  std::vector<std::uint8_t> bytes(drawn.size(), out_of_reach);
  parallel_blocks(bytes.size(), threads, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d point = place * drawn[i];
      const std::int64_t nearest = grid.nearest(point.cast<float>(), static_cast<float>(reach));
      if (nearest < 0) continue;
      const double distance = (target.points[nearest] - point).norm();
      bytes[i] = static_cast<std::uint8_t>(std::min(254L, std::lround(254.0 * distance / reach)));
    }
  });
  return bytes;
}

/// Both clouds as their scanners saw each other, as far as the run knows where these stood.
class SeenThrough {
 public:
  SeenThrough(const Json& run, const LocalCloud& source, const LocalCloud& target)
      : threads_(run["options"]["threads"].get<int>()),
        source_(images_of(source, run["voxel_size"].get<double>())),
        target_(images_of(target, run["voxel_size"].get<double>())) {}

  /// For each cloud the points that contradict the pose, null where nothing is known.
  Json contradicting(const Points& source, const Points& target, const Transformation& place) const {
    const auto bytes_of = [&](const Points& points, const std::vector<RangeImage>& seen, const auto& motion) {
      return seen.empty() ? Json(nullptr) : Json(base64(seen_through(points, seen, motion, threads_)));
    };
    return {{"source", bytes_of(source, target_, place)}, {"target", bytes_of(target, source_, place.inverse())}};
  }
  bool knows_any() const { return !source_.empty() || !target_.empty(); }

 private:
  static std::vector<RangeImage> images_of(const LocalCloud& cloud, double voxel_size) {
    std::vector<RangeImage> images;
    std::size_t begin = 0;
    for (const ScanPart& part : cloud.parts) {
      const PointView points = PointView(cloud.points).subspan(begin, part.points);
      begin += points.size();
      if (part.viewpoint) images.push_back(range_image_of(points, *part.viewpoint - cloud.origin, voxel_size));
    }
    return images;
  }

  int threads_;
  std::vector<RangeImage> source_, target_;
};

}  // namespace

Json report_scene(const Json& run, const Scan& source_scan, const Scan& target_scan) {
  const LocalCloud source = localised(source_scan, "source"), target = localised(target_scan, "target");
  const std::vector<Pose> poses = poses_of(run);
  const SeenThrough seen(run, source, target);
  const std::size_t pose_bytes = seen.knows_any() ? 3 : 1;
  const std::size_t budget = max_scene_bytes / (2 * point_bytes + pose_bytes * poses.size());
  const std::size_t count = std::max<std::size_t>(1, std::min(max_drawn_points, budget));
  const Points drawn = thinned(source.points, count), drawn_target = thinned(target.points, count);
  const double voxel_size = run["voxel_size"].get<double>(), reach = reach_in_voxels * voxel_size;
  const PointGrid grid(target.points, reach / 6.0);
  const int threads = run["options"]["threads"].get<int>();
  const double room = source.bounds.diagonal() + target.bounds.diagonal();

  Json scene = {{"reach", reach}, {"reach_in_voxels", reach_in_voxels}};
  scene["source"] = drawn_cloud(source, drawn, voxel_size, threads);
  scene["target"] = drawn_cloud(target, drawn_target, voxel_size, threads);
  scene["poses"] = Json::array();
  for (const Pose& pose : poses) {
    stop_if_interrupted();
    Transformation place = pose.target_from_source;  // of the source's local coordinates in the target's
    place.translation() = pose.target_from_source * source.origin - target.origin;
    const Json contradicting = seen.contradicting(drawn, drawn_target, place);
    const bool far = place.translation().norm() > 2.0 * room;
    const double distance = place.translation().norm();
    if (far) place.translation() = 0.55 * room * Eigen::Vector3d::UnitX();
    scene["poses"].push_back({{"kind", pose.kind},
                              {"k", pose.k},
                              {"matrix", cli::to_json(place)},
                              {"drawn_nearer", far ? Json(distance) : Json(nullptr)},
                              {"distances", base64(distances(drawn, target, grid, place, reach, threads))},
                              {"contradicting", contradicting}});
  }
  return scene;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) group = group << 8 | (j < have ? bytes[i + j] : 0);
    for (std::size_t j = 0; j < 4; ++j) text += j <= have ? digits[group >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

}  // namespace igsp::cli
