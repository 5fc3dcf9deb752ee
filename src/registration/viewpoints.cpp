#include "registration/viewpoints.hpp"

#include "spatial/point_grid.hpp"

namespace igsp {
namespace {

constexpr double beside_point = 1.5;  // voxels: a scan that has no point as near did not see this one

}  // namespace

Viewpoints::Viewpoints(const std::optional<Eigen::Vector3d>& viewpoint) {
  if (viewpoint) viewpoints_.push_back(*viewpoint);
}

Viewpoints::Viewpoints(const Features& cloud, PointView points) : Viewpoints(cloud.viewpoint) {
  if (cloud.parts.empty()) return;
  Points seen;
  std::vector<std::uint32_t> scan_of_seen;
  for (const ScannedPart& part : cloud.parts) {
    scan_of_seen.insert(scan_of_seen.end(), part.fine_points.size(), static_cast<std::uint32_t>(viewpoints_.size()));
    seen.insert(seen.end(), part.fine_points.begin(), part.fine_points.end());
    viewpoints_.push_back(part.viewpoint);
  }
  const PointGrid grid(seen, cloud.voxel_size);
  const auto reach = static_cast<float>(beside_point * cloud.voxel_size);
  for (const Eigen::Vector3d& point : points) {
    const std::int64_t nearest = grid.nearest(point.cast<float>(), reach);
    scan_of_point_.push_back(nearest < 0 ? static_cast<std::uint32_t>(viewpoints_.size()) : scan_of_seen[nearest]);
  }
}

}  // namespace igsp
