#include "network/drawn_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "igsp/errors.hpp"
#include "shell/interrupt.hpp"
#include "spatial/bounds.hpp"
#include "spatial/point_grid.hpp"

namespace igsp::cli {
namespace {

constexpr std::size_t points_of_a_page = 60'000;  // 13 bytes each: the page of a usual survey stays below 2 MB
constexpr std::size_t least_points = 300, most_points = 4000;

constexpr float infinite = std::numeric_limits<float>::infinity();

/// Of the voxels that were looked at so far.
struct NearestVoxel {
  float distance = infinite;
  float along_normal = infinite;
};

/// The voxels of one scan, asked by the drawn points of the others.
class Surface {
 public:
  Surface(const Features& features, double reach)
      : features_(features),
        reach_(static_cast<float>(reach)),
        grid_(features.points, reach / 3.0),
        bounds_(bounds_of(features.points, "scan")) {
    bounds_.min.array() -= reach;
    bounds_.max.array() += reach;
  }

  /// `point` in the coordinates of the features.
  void look(const Eigen::Vector3d& point, NearestVoxel& best) const {
    if ((point.array() < bounds_.min.array()).any() || (point.array() > bounds_.max.array()).any()) return;
    const std::int64_t found = grid_.nearest(point.cast<float>(), std::min(reach_, best.distance));
    if (found < 0) return;
    const Eigen::Vector3d offset = point - features_.points[found];
    best.distance = static_cast<float>(offset.norm());
    best.along_normal = static_cast<float>(std::abs(offset.dot(features_.normals[found])));
  }

 private:
  const Features& features_;  // must outlive this
  float reach_;
  PointGrid grid_;
  Bounds bounds_;
};

// Asks a scan's surface about all drawn points of another one.
void look_all(const Surface& surface, const Transformation& surface_from_points, const std::vector<float>& points,
              std::vector<NearestVoxel>& nearest, int threads) {
  parallel_blocks(nearest.size(), threads, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Eigen::Vector3d point = Eigen::Vector3f::Map(&points[3 * p]).cast<double>();
      surface.look(surface_from_points * point, nearest[p]);
    }
  });
}

std::vector<std::vector<NearestVoxel>> nearest_voxels(std::span<const DrawnScan> drawn, const Network& network,
                                                      const FeatureSource& features, int threads) {
  std::vector<std::vector<NearestVoxel>> nearest(drawn.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) nearest[i].resize(drawn[i].points.size() / 3);
  for (const std::vector<std::size_t>& component : network.components) {
    if (component.size() < 2) continue;
    for (const std::size_t other : component) {
      stop_if_interrupted();
      const Features of_other = features(other);
      const Surface surface(of_other, neighbour_reach * network.voxel_size);
      for (const std::size_t scan : component) {
        if (scan == other) continue;
        Transformation place = network.scans[other].world_from_scan.inverse() * network.scans[scan].world_from_scan;
        place.translation() = place * drawn[scan].origin - of_other.origin;  // of coordinates relative to the origins
        look_all(surface, place, drawn[scan].points, nearest[scan], threads);
      }
    }
  }
  return nearest;
}

}  // namespace

DrawnScan drawn_scan(const Features& features, std::size_t scans) {
  DrawnScan drawn;
  drawn.origin = features.origin;
  drawn.station_known = features.viewpoint.has_value();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  const std::size_t size = features.points.size();
  for (const Eigen::Vector3d& point : features.points) centre += point / static_cast<double>(size);
  drawn.station = features.origin + features.viewpoint.value_or(centre);
  const std::size_t wanted = std::clamp(points_of_a_page / std::max<std::size_t>(1, scans), least_points, most_points);
  const std::size_t stride = std::max<std::size_t>(1, size / wanted);
  for (std::size_t i = 0; i < size; i += stride) {
    for (const double number : features.points[i]) drawn.points.push_back(static_cast<float>(number));
  }
  return drawn;
}

void measure_drawn(std::span<DrawnScan> drawn, const Network& network, const FeatureSource& features, int threads) {
  std::vector<std::vector<NearestVoxel>> nearest;
  try {
    nearest = nearest_voxels(drawn, network, features, threads);
  } catch (const FileError&) {
    return;  // what colours a picture must not cost the answer
  }
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    for (const NearestVoxel& voxel : nearest[i]) drawn[i].distances.push_back(voxel.along_normal);
  }
}

}  // namespace igsp::cli
