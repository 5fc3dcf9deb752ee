#include "registration/self_likeness.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace igsp {
namespace {

// What lies on itself after any turn does after a half, a third or a fifth of one; seven legs are not looked for.
constexpr std::array<double, 3> likely_turns_rad{std::numbers::pi, 2 * std::numbers::pi / 3, 2 * std::numbers::pi / 5};
constexpr double least_turn_rad = std::numbers::pi / 6;  // smaller ones are near poses, which the search has seen
constexpr double same_turn_rad = std::numbers::pi / 36;

// What may lie on itself is found with few points: a third of them near the surface are enough to begin with, since the
// sampling tilts the axes, and nearly all have to lie on it once the turn has settled.
constexpr std::size_t few = 200, many = 1500;      // points
constexpr double roughly_near = 2, likely = 0.35;  // voxels; share of the points, turned
constexpr double nearly_near = 1, very_likely = 0.88;
constexpr std::array<double, 4> first_radii{6, 4, 2.5, 1.5};  // voxels
constexpr std::array<double, 3> last_radii{2, 1.5, 1};
constexpr double near = 0.75, on_itself = 0.96;
constexpr double keypoints_on_itself = 0.9;  // three boxes on a field are few of its points
// Of a point from the surface that it lies on: walls have gaps where the scanner saw them from the side.
constexpr double reach = 4;  // voxels

struct Frame {
  Eigen::Vector3d origin;
  Eigen::Matrix3d axes;  // columns
  Transformation turn(int axis, double angle_rad) const {
    return Eigen::Translation3d(origin) * Eigen::AngleAxisd(angle_rad, axes.col(axis)) * Eigen::Translation3d(-origin);
  }
};

Eigen::Matrix3d eigenvectors(const Eigen::Matrix3d& moments) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors();
}

// The principal axes: of what is sampled evenly.
Frame frame_of_points(const Points& points) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) centroid += point / static_cast<double>(points.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) moments += (point - centroid) * (point - centroid).transpose();
  return {centroid, eigenvectors(moments)};
}

// Of a room seen from a corner: how many points a wall has changes neither its direction nor where the cloud ends.
Frame frame_of_walls(const Features& cloud) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& normal : cloud.normals) moments += normal * normal.transpose();
  const Eigen::Matrix3d axes = eigenvectors(moments);
  Eigen::AlignedBox3d extent;
  for (const Eigen::Vector3d& point : cloud.points) extent.extend(axes.transpose() * point);
  return {axes * extent.center(), axes};
}

// Share of the points, turned, within so many voxels of the surface.
double share_on_itself(const Transformation& turn, const PreparedCloud& cloud, PointView points, double near_voxels,
                       std::size_t max_points) {
  const double v = cloud.features.voxel_size;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / max_points);
  std::size_t asked = 0, found = 0;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    ++asked;
    const Eigen::Vector3d point = turn * points[i];
    const std::int64_t j = cloud.grid.nearest(point.cast<float>(), static_cast<float>(reach * v));
    found += j >= 0 && std::abs(cloud.features.normals[j].dot(point - cloud.features.points[j])) < near_voxels * v;
  }
  return asked > 0 ? static_cast<double>(found) / static_cast<double>(asked) : 1.0;
}

bool lies_on_itself_after(const Transformation& turn, const PreparedCloud& cloud) {
  return share_on_itself(turn, cloud, cloud.features.points, near, many) >= on_itself &&
         share_on_itself(turn, cloud, cloud.keypoints, near, many) >= keypoints_on_itself;
}

double angle_rad_of(const Transformation& turn) {
  return Eigen::AngleAxisd(turn.linear()).angle();
}

bool is_known(const Transformation& turn, const std::vector<Transformation>& found) {
  return std::ranges::any_of(found, [&](const Transformation& other) {
    return std::min(angle_rad_of(turn * other), angle_rad_of(turn * other.inverse())) < same_turn_rad;
  });
}

}  // namespace

std::vector<Transformation> turns_onto_itself(const PreparedCloud& cloud) {
  std::vector<Transformation> found;
  const Points& points = cloud.features.points;
  if (points.empty()) return found;
  const Surface surface = surface_of(cloud);
  const double v = cloud.features.voxel_size;
  const PointToPlaneOptions roughly{few, few, first_radii, 0, v, 6, 1}, finely{many, many, last_radii, 0, v, 6, 1};
  for (const Frame& frame : {frame_of_points(points), frame_of_walls(cloud.features)}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double angle_rad : likely_turns_rad) {
        Transformation turn = frame.turn(axis, angle_rad);
        if (share_on_itself(turn, cloud, points, roughly_near, few) < likely) continue;
        turn = refine_point_to_plane(surface, surface, turn, roughly);
        if (angle_rad_of(turn) < least_turn_rad || is_known(turn, found)) continue;
        if (share_on_itself(turn, cloud, points, nearly_near, few) < very_likely) continue;
        turn = refine_point_to_plane(surface, surface, turn, finely);
        if (lies_on_itself_after(turn, cloud)) found.push_back(turn);
      }
    }
  }
  return found;
}

}  // namespace igsp
