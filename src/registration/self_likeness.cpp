#include "registration/self_likeness.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace igsp {
namespace {

// Around an axis the points are counted in rings of so many heights and distances, divided into angles.
constexpr int heights = 8, distances = 6;
constexpr int angles = 180;                  // of 2 degrees: a voxel at the rim of a cloud of 60 voxels across
constexpr int least_turn = angles / 12;      // smaller ones are near poses, which the search has seen
constexpr std::size_t turns_about_axis = 2;  // a third and a half; where more fit, these do as well
constexpr double roughly_on_itself = 0.8, on_itself = 0.99;  // share of the points, turned
constexpr double keypoints_on_itself = 0.9;                  // three boxes on a field are few of its points
constexpr double roughly_near = 2, near = 0.75;              // voxels from the surface
constexpr double reach = 2;                                  // voxels: sparse surfaces have gaps
constexpr std::size_t max_settled = 1500;
constexpr std::array<double, 5> radii{3, 2, 2, 1.5, 1};  // voxels

struct Axis {
  Eigen::Vector3d origin, direction;
  Transformation turn(double angle_rad) const {
    return Eigen::Translation3d(origin) * Eigen::AngleAxisd(angle_rad, direction) * Eigen::Translation3d(-origin);
  }
};

std::array<Axis, 3> principal_axes(PointView points) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) centroid += point / static_cast<double>(points.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) moments += (point - centroid) * (point - centroid).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
  std::array<Axis, 3> axes;
  for (int i = 0; i < 3; ++i) axes[i] = {centroid, solver.eigenvectors().col(i)};
  return axes;
}

using Ring = std::array<float, angles>;  // numbers of points

std::vector<Ring> rings_around(const Axis& axis, PointView points) {
  struct Place {
    double height, distance, angle;  // angle in turns, [0, 1]
  };
  const Eigen::Vector3d across = axis.direction.unitOrthogonal(), third = axis.direction.cross(across);
  std::vector<Place> places;
  double lowest = 0, highest = 0, farthest = 0;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d p = point - axis.origin;
    const double x = across.dot(p), y = third.dot(p);
    places.push_back({axis.direction.dot(p), std::hypot(x, y), 0.5 + std::atan2(y, x) / (2 * std::numbers::pi)});
    lowest = std::min(lowest, places.back().height);
    highest = std::max(highest, places.back().height);
    farthest = std::max(farthest, places.back().distance);
  }
  std::vector<Ring> rings(heights * distances, Ring{});
  const auto bin = [](double share, int bins) { return std::clamp(static_cast<int>(share * bins), 0, bins - 1); };
  for (const Place& place : places) {
    const double up = highest > lowest ? (place.height - lowest) / (highest - lowest) : 0;
    const double out = farthest > 0 ? place.distance / farthest : 0;
    rings[bin(up, heights) * distances + bin(out, distances)][bin(place.angle, angles)] += 1;
  }
  return rings;
}

// How much the rings are like themselves after a turn by i + least_turn angles, up to half a turn.
std::vector<double> likeness_after_turns(const std::vector<Ring>& rings) {
  std::vector<double> likeness;
  for (int turn = least_turn; turn <= angles / 2; ++turn) {
    double sum = 0;
    for (const Ring& ring : rings) {
      for (int i = 0; i < angles; ++i) sum += ring[i] * ring[(i + turn) % angles];
    }
    likeness.push_back(sum);
  }
  return likeness;
}

// The turns [rad] after which a cloud is more like itself than after any a little smaller or larger, the best first.
std::vector<double> likely_turns(const Axis& axis, PointView points) {
  const std::vector<double> likeness = likeness_after_turns(rings_around(axis, points));
  std::vector<std::size_t> peaks;
  for (std::size_t i = 0; i < likeness.size(); ++i) {
    const bool above_smaller = i == 0 || likeness[i] >= likeness[i - 1];
    const bool above_larger = i + 1 == likeness.size() || likeness[i] > likeness[i + 1];
    if (above_smaller && above_larger) peaks.push_back(i);
  }
  std::ranges::stable_sort(peaks, [&](std::size_t a, std::size_t b) { return likeness[a] > likeness[b]; });
  std::vector<double> turns;
  for (const std::size_t i : peaks) {
    if (turns.size() == turns_about_axis) break;
    turns.push_back(2 * std::numbers::pi * (static_cast<double>(i) + least_turn) / angles);
  }
  return turns;
}

// Share of the points, turned, within so many voxels of the surface.
double share_on_itself(const PreparedCloud& cloud, PointView points, const Transformation& turn, double voxels) {
  const double v = cloud.features.voxel_size;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / max_settled);
  std::size_t looked_at = 0, found = 0;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    ++looked_at;
    const Eigen::Vector3d point = turn * points[i];
    const std::int64_t j = cloud.grid.nearest(point.cast<float>(), static_cast<float>(reach * v));
    found += j >= 0 && std::abs(cloud.features.normals[j].dot(point - cloud.features.points[j])) < voxels * v;
  }
  return looked_at > 0 ? static_cast<double>(found) / static_cast<double>(looked_at) : 1.0;
}

}  // namespace

std::vector<Transformation> turns_onto_itself(const PreparedCloud& cloud) {
  std::vector<Transformation> found;
  const Points& points = cloud.features.points;
  if (points.empty()) return found;
  const Surface surface = surface_of(cloud);
  const PointToPlaneOptions settling{max_settled, max_settled, radii, 0, cloud.features.voxel_size, 6, 1};
  for (const Axis& axis : principal_axes(points)) {
    for (const double angle_rad : likely_turns(axis, points)) {
      Transformation turn = axis.turn(angle_rad);
      if (share_on_itself(cloud, points, turn, roughly_near) < roughly_on_itself) continue;
      turn = refine_point_to_plane(surface, surface, turn, settling);
      if (share_on_itself(cloud, points, turn, near) < on_itself) continue;
      if (share_on_itself(cloud, cloud.keypoints, turn, near) >= keypoints_on_itself) found.push_back(turn);
    }
  }
  return found;
}

}  // namespace igsp
