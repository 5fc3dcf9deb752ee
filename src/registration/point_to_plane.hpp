#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "igsp/point_cloud.hpp"
#include "registration/viewpoints.hpp"
#include "spatial/point_grid.hpp"

namespace igsp {

/// A sampled surface with its search structure; normals are computed where they are asked for and kept, for several
/// threads at once. Refers to `points`.
class Surface {
 public:
  /// `normal_radius`: sphere of the principal component analysis.
  Surface(PointView points, PointGrid grid, double normal_radius, Viewpoints viewpoints = Viewpoints())
      : points_(points),
        grid_(std::move(grid)),
        normal_radius_(normal_radius),
        viewpoints_(std::move(viewpoints)),
        normals_(points.size()),
        states_(points.size()) {}
  /// With normals that are known already.
  Surface(PointView points, PointGrid grid, Points normals, Viewpoints viewpoints = Viewpoints())
      : points_(points),
        grid_(std::move(grid)),
        normal_radius_(0),
        viewpoints_(std::move(viewpoints)),
        normals_(std::move(normals)) {}

  std::size_t size() const { return points_.size(); }
  PointView points() const { return points_; }
  const Eigen::Vector3d& point(std::size_t i) const { return points_[i]; }
  const PointGrid& grid() const { return grid_; }
  Eigen::Vector3d normal(std::size_t i) const;                                         ///< unit, sign arbitrary
  const Eigen::Vector3d* viewpoint(std::size_t i) const { return viewpoints_.of(i); }  ///< null: not known

 private:
  enum State : std::uint8_t { unknown, being_kept, known };
  PointView points_;
  PointGrid grid_;
  double normal_radius_;
  Viewpoints viewpoints_;
  mutable Points normals_;
  mutable std::vector<std::atomic<State>> states_;  // empty where all are known
};

struct PointToPlaneOptions {
  std::size_t early_points = 0;    ///< of the source, evenly strided, until the last radius
  std::size_t max_points = 0;      ///< the same at the last radius
  std::span<const double> radii;   ///< one Gauss-Newton step each: search radius [voxels]
  std::size_t max_last_steps = 0;  ///< further steps at the last radius, until they are small
  double voxel_size = 0;
  int degrees_of_freedom = 6;
  int threads = 1;
};

/// Fine registration: every step pairs points of the source with their nearest point of the target within the radius
/// whose normal agrees, unless they were seen from either side, and minimises the distances along the sum of both
/// normals (Rusinkiewicz 2019, symmetric ICP) under the Geman-McClure loss at half the radius, at the last radius at
/// loss_scale_of the step before. Ends early where a step finds too few pairs or a free direction. Returns
/// target_from_source.
Transformation refine_point_to_plane(const Surface& source, const Surface& target, const Transformation& initial,
                                     const PointToPlaneOptions& options);

/// How much larger the source would have to be to fit best.
struct ScaleFit {
  double factor = 1;
  double sigma = 0;                   ///< of the factor, from the residuals; infinite where nothing tells
  Transformation target_from_source;  ///< of the source after it is multiplied by the factor
};

/// Seven parameters from a pose that is nearly right: as refine_point_to_plane, and a growth of the source. `options`:
/// the radii and max_points, one step a radius.
ScaleFit fit_scale(const Surface& source, const Surface& target, const Transformation& initial,
                   const PointToPlaneOptions& options);

/// The normal equations of one step at a pose: sum of J^T w J and of J^T w r over pairs, and the variance of their
/// residuals. Rotations about `centre` (target frame) first, then translations.
struct Linearisation {
  Eigen::Vector3d centre;
  Eigen::Matrix<double, 6, 6> hessian;
  Eigen::Matrix<double, 6, 1> gradient;
  double residual_variance = 0;  ///< [units of the cloud ^ 2]
  std::size_t pairs = 0;
};
/// `loss_scale` of the Geman-McClure loss; 0: half the radius.
Linearisation linearise_at(const Surface& source, const Surface& target, const Transformation& pose, double radius,
                           std::size_t max_points, int threads = 1, double loss_scale = 0);

/// Of the Geman-McClure loss where residuals have this variance: three sigmas, but no less than what voxels resolve and
/// no more than half the radius. Surfaces that lie on each other well take no notice of what is only near them, such as
/// the other side of a trunk.
double loss_scale_of(double residual_variance, double radius, double voxel_size);

/// A point of the source that lies beside a place of the target, as linearise_at pairs them; in the target's frame.
struct PlanePair {
  Eigen::Vector3d place;   ///< the point, moved
  Eigen::Vector3d normal;  ///< unit, of both surfaces
  double residual;         ///< the point's distance from the target along the normal
};
std::vector<PlanePair> plane_pairs_at(const Surface& source, const Surface& target, const Transformation& pose,
                                      double radius, std::size_t max_points, int threads = 1);

}  // namespace igsp
