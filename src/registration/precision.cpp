#include "registration/precision.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.hpp"
#include "registration/pose_covariance.hpp"
#include "registration/surface_contact.hpp"

namespace igsp {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// The normal equations propose directions, sorted by the root mean square change of the distances per unit of motion;
// the contact after a trial motion decides. The equations alone cannot: an endless corridor lies at 0.01 to 0.05 and
// scenes with corners above 0.2, but stray normals of sparse scan lines, far out on a long lever, lift a plane's
// rotation about its normal to 0.6.
constexpr double well_fixed = 0.7;
constexpr double loosest = 0.15;             // where no direction lies below, none of them is free
constexpr double trial_motion = 8.0;         // voxels
constexpr double unchanged_contact = 0.975;  // corridors, planes: 0.98 and more; others: few parks above 0.95
constexpr double hardly_seen = 0.02;         // bodies of revolution: 0.005 to 0.016, which is next to proof, ...
constexpr double similar_contact = 0.95;     // ... so a pose that is a little off may touch a little less
constexpr double search_radius = 1.5;        // voxels
// A turn by one radian, or a shift by the size of the cloud, that a surface allows moves its places by the unevenness
// of the voxels, all of them alike: by 0.15 to 1.3 voxels (RMS) on sparse cylinders and corridors, the median being 0.3
// of that and more. Poses that are fixed: 1.5 voxels and more (objects of 1,200 points from 1.1 on), or, three boxes on
// a field, a median below 0.06.
constexpr double unevenness = 1.3;  // voxels
constexpr double alike = 0.15;
constexpr std::size_t max_points = 1500;

constexpr double fine_normal_radius = 1.5;  // voxels
constexpr double fine_search_radius = 1.0;  // voxels: that of the last refinement steps
constexpr std::size_t max_fine_points = 8000;

constexpr std::array<double, 6> scale_radii{3, 3,   2,
                                            2, 1.5, 1};  // voxels: ends of a scan that is 5 % too long lie far off
constexpr std::size_t max_scale_points = 2000;

// Surfaces at a right pose differ in scale by up to 2.4 % (hand-held depth cameras), those of laser scanners by 0.6 %.
constexpr double largest_scale_error = 0.035;  // of the logarithm of the factor
constexpr double certain_sigmas = 10;          // residuals are correlated, so their sigma is too small

// `motion`: rotation scaled by `size`, translation.
Transformation motion_about(const Eigen::Vector3d& centre, const Vector6& motion, double size) {
  const Eigen::Vector3d rotation = motion.head<3>() / size;
  Transformation result = Transformation::Identity();
  if (rotation.norm() > 0)
    result.linear() = Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
  result.translation() = centre + motion.tail<3>() - result.linear() * centre;
  return result;
}

// Of at least one value.
double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

std::string describe_motion(const Vector6& motion) {
  const Eigen::Vector3d rotation = motion.head<3>(), translation = motion.tail<3>();
  const auto axis = [](Eigen::Vector3d a) {
    a.normalize();
    Eigen::Index largest;
    a.cwiseAbs().maxCoeff(&largest);
    if (a[largest] < 0) a = -a;
    return fmt::format("({:.2f}, {:.2f}, {:.2f})", a.x(), a.y(), a.z());
  };
  if (rotation.norm() < 0.3) return "translation along " + axis(translation);
  // Translation across the axis only moves the axis; translation along it makes a screw.
  const double along = std::abs(rotation.normalized().dot(translation));
  return (along < 0.3 ? "rotation about " : "screw motion about ") + axis(rotation);
}

double size_of(PointView points) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) centre += point / static_cast<double>(points.size());
  double squares = 0;
  for (const Eigen::Vector3d& point : points) squares += (point - centre).squaredNorm();
  return points.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(points.size()));
}

FineSurfaces::FineSurfaces(const Features& source_features, const Features& target_features, int number_of_threads)
    : source(source_features.fine_points, PointGrid(source_features.fine_points, source_features.voxel_size),
             fine_normal_radius * source_features.voxel_size, Viewpoints(source_features, source_features.fine_points)),
      target(target_features.fine_points, PointGrid(target_features.fine_points, target_features.voxel_size),
             fine_normal_radius * target_features.voxel_size, Viewpoints(target_features, target_features.fine_points)),
      voxel_size(target_features.voxel_size),
      threads(number_of_threads) {}

Precision precision_at(const FineSurfaces& surfaces, const Transformation& target_from_source, int degrees_of_freedom) {
  const double radius = fine_search_radius * surfaces.voxel_size;
  const PoseCovariance pose = pose_covariance(
      plane_pairs_at(surfaces.source, surfaces.target, target_from_source, radius, max_fine_points, surfaces.threads),
      radius, surfaces.voxel_size, degrees_of_freedom);
  Precision precision;
  precision.centre = pose.centre;
  precision.inlier_rmse = std::sqrt(pose.residual_variance);
  precision.information = pose.information;
  precision.covariance = pose.covariance;
  if (!(pose.residual_variance > 0)) return precision;
  const ScaleFit scale =
      fit_scale(surfaces.source, surfaces.target, target_from_source,
                {0, max_scale_points, scale_radii, 0, surfaces.voxel_size, degrees_of_freedom, surfaces.threads});
  if (std::isfinite(scale.sigma)) {
    precision.scale = scale.factor;
    precision.scale_sigma = scale.sigma;
  }
  return precision;
}

bool is_of_another_scale(const Precision& precision) {
  const double error = std::abs(std::log(precision.scale));
  return precision.scale_sigma > 0 &&
         error > largest_scale_error + certain_sigmas * precision.scale_sigma / precision.scale;
}

std::vector<FreeDirection> free_directions(const PreparedCloud& moved, const PreparedCloud& fixed,
                                           const Transformation& fixed_from_moved, int threads) {
  const double v = fixed.features.voxel_size;
  const double size = size_of(moved.features.points);
  const Surface moved_surface = surface_of(moved), fixed_surface = surface_of(fixed);
  const Linearisation at_pose =
      linearise_at(moved_surface, fixed_surface, fixed_from_moved, search_radius * v, max_points, threads);
  if (at_pose.pairs == 0 || !(size > 0)) return {};
  Vector6 scale;
  scale << Eigen::Vector3d::Constant(1 / size), Eigen::Vector3d::Ones();
  const Matrix6 scaled = scale.asDiagonal() * at_pose.hessian * scale.asDiagonal();
  // Normals are unit vectors, so the trace of the translations is the sum of the weights.
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scaled / scaled.bottomRightCorner<3, 3>().trace());

  if (solver.eigenvalues()[0] > loosest * loosest) return {};

  const double contact = surface_contact(moved, fixed, fixed_from_moved).share;
  const auto still_touches = [&](const Vector6& motion, double share) {
    const Transformation tried = motion_about(at_pose.centre, motion, size) * fixed_from_moved;
    return surface_contact(moved, fixed, tried).share > share * contact &&
           surface_contact(fixed, moved, tried.inverse()).share > share * contact;
  };
  // Where few voxels lie across a body, a trial motion of several leaves it, whatever its axis.
  const auto is_unevenness = [&](const Vector6& motion, double seen) {
    if (seen * size > unevenness * v) return false;
    const Eigen::Vector3d rotation_rad = motion.head<3>(), translation = size * motion.tail<3>();
    std::vector<double> shifts;
    for (const PlanePair& pair :
         plane_pairs_at(moved_surface, fixed_surface, fixed_from_moved, search_radius * v, max_points)) {
      shifts.push_back(std::abs(pair.normal.dot(rotation_rad.cross(pair.place - at_pose.centre) + translation)));
    }
    return !shifts.empty() && median_of(std::move(shifts)) > alike * seen * size;
  };
  const auto is_free = [&](std::size_t i) {
    const Vector6 motion = solver.eigenvectors().col(i);
    const double seen = std::sqrt(std::max(0.0, solver.eigenvalues()[i]));
    if (seen >= well_fixed) return false;
    const double share = seen < hardly_seen ? similar_contact : unchanged_contact;
    return is_unevenness(motion, seen) ||
           (still_touches(trial_motion * v * motion, share) && still_touches(-trial_motion * v * motion, share));
  };
  std::array<bool, 6> free{};
  parallel_blocks(free.size(), threads, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) free[i] = is_free(i);
  });
  std::vector<FreeDirection> found;
  for (int i = 0; i < 6; ++i) {
    if (!free[i]) continue;
    const Vector6 motion = solver.eigenvectors().col(i);
    found.push_back({motion, describe_motion(motion)});
  }
  return found;
}

}  // namespace igsp
