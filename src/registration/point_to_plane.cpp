#include "registration/point_to_plane.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "estimation/robust_fit.hpp"
#include "registration/facing.hpp"
#include "spatial/local_pca.hpp"

namespace igsp {
namespace {

constexpr double min_normal_cosine = 0.7;
constexpr std::size_t min_pairs = 30;
constexpr std::size_t block = 512;  // points of the sample that one thread takes at a time
constexpr double max_growth = 0.1;  // of one step
constexpr double loss_sigmas = 3.0;
constexpr double least_loss_scale = 0.15;  // voxels

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector7 = Eigen::Matrix<double, 7, 1>;

// Unknowns: a small rotation about `centre`, a translation, and a growth about the centre, which only fit_scale solves
// for; all move the source.
struct NormalEquations {
  Eigen::Vector3d centre;
  double loss_scale;
  Matrix7 information = Matrix7::Zero();
  Vector7 gradient = Vector7::Zero();
  std::size_t pairs = 0;
  double weight_sum = 0, weighted_squares = 0;
  Eigen::Vector3d weighted_places = Eigen::Vector3d::Zero();

  double residual_variance() const { return weight_sum > 0 ? weighted_squares / weight_sum : 0.0; }

  // p as moved by the current pose, q of the target, n the normal of both.
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& n) {
    const double residual = n.dot(p - q);
    const double weight = geman_mcclure_weight(residual * residual, loss_scale * loss_scale);
    Vector7 jacobian;
    jacobian << (p - centre).cross(n), n, (p - centre).dot(n);
    information += weight * jacobian * jacobian.transpose();
    gradient += weight * residual * jacobian;
    weight_sum += weight;
    weighted_places += weight * p;
    weighted_squares += weight * residual * residual;
    ++pairs;
  }

  // Of other pairs at the same pose.
  void add(const NormalEquations& other) {
    information += other.information;
    gradient += other.gradient;
    weight_sum += other.weight_sum;
    weighted_places += other.weighted_places;
    weighted_squares += other.weighted_squares;
    pairs += other.pairs;
  }

  // Rotations and growth about the centroid of the pairs, which does not depend on where the cloud's other points are:
  // (p - c') x n = (p - c) x n - (c' - c) x n, and likewise with the dot product, so J' = T J.
  void move_centre_to_pairs() {
    if (!(weight_sum > 0)) return;
    const Eigen::Vector3d centroid = weighted_places / weight_sum, shift = centroid - centre;
    Matrix7 moved = Matrix7::Identity();
    moved.block<3, 3>(0, 3) << 0, shift.z(), -shift.y(), -shift.z(), 0, shift.x(), shift.y(), -shift.x(), 0;
    moved.block<1, 3>(6, 3) = -shift.transpose();
    information = moved * information * moved.transpose();
    gradient = moved * gradient;
    centre = centroid;
  }
};

// Of every point of the source its nearest point of the target as last found, or -1.
using Partners = std::vector<std::int64_t>;

// The nearest point within the radius. The last one bounds the sphere that has to be searched.
std::int64_t nearest_point(const Surface& target, const Eigen::Vector3f& p, float radius, std::int64_t* last) {
  if (!last) return target.grid().nearest(p, radius);
  if (*last >= 0) {
    const float distance = 1.0001f * (target.point(*last).cast<float>() - p).norm();
    radius = std::min(radius, distance);
    if (distance == radius) return *last = target.grid().nearest_within(p, radius);
  }
  return *last = target.grid().nearest(p, radius);
}

// Every stride-th point of a surface.
struct Sample {
  Sample(const Surface& surface, std::size_t max_points)
      : stride(std::max<std::size_t>(1, surface.size() / max_points)), size((surface.size() + stride - 1) / stride) {}
  std::size_t stride, size;
};

// visit(p, q, n) for points of the source, [begin, end) of the sample, and their nearest point of the target, where
// their normals agree and they are not the two sides of a wall: p as moved, n the unit sum of both normals. `scale`: of
// the source, before the pose.
template <typename Visit>
void visit_pairs(const Surface& source, const Surface& target, const Transformation& pose, double scale, double radius,
                 const Sample& sample, std::size_t begin, std::size_t end, Partners* partners, const Visit& visit) {
  for (std::size_t i = begin * sample.stride; i < std::min(source.size(), end * sample.stride); i += sample.stride) {
    const Eigen::Vector3d p = pose * (scale * source.point(i));
    const std::int64_t j =
        nearest_point(target, p.cast<float>(), static_cast<float>(radius), partners ? &(*partners)[i] : nullptr);
    if (j < 0) continue;
    const Eigen::Vector3d own_normal = source.normal(i), q_normal = target.normal(j);
    const Eigen::Vector3d p_normal = pose.linear() * own_normal;
    const double cosine = p_normal.dot(q_normal);
    if (std::abs(cosine) < min_normal_cosine) continue;
    if (are_two_sides({source.point(i), own_normal, source.viewpoint(i)},
                      {target.point(j), q_normal, target.viewpoint(j)}, cosine)) {
      continue;
    }
    visit(p, target.point(j), (q_normal + std::copysign(1.0, cosine) * p_normal).normalized());
  }
}

// Summed up in blocks, and these in their order: the same bits for every number of threads.
NormalEquations linearise(const Surface& source, const Surface& target, const Transformation& pose, double scale,
                          double radius, double loss_scale, std::size_t max_points, int threads,
                          Partners* partners = nullptr) {
  const Sample sample(source, max_points);
  const NormalEquations none{pose.translation(), loss_scale};
  std::vector<NormalEquations> parts((sample.size + block - 1) / block, none);
  parallel_blocks(parts.size(), threads, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      visit_pairs(
          source, target, pose, scale, radius, sample, k * block, (k + 1) * block, partners,
          [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& n) { parts[k].add(p, q, n); });
    }
  });
  NormalEquations equations = none;
  for (const NormalEquations& part : parts) equations.add(part);
  equations.move_centre_to_pairs();
  return equations;
}

Transformation motion(const Vector6& step, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d rotation = step.head<3>();
  const double angle = rotation.norm();
  Transformation result = Transformation::Identity();
  if (angle > 0) result.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  result.translation() = centre + step.tail<3>() - result.linear() * centre;
  return result;
}

// Levelled scans: yaw and translation only, so the two tilts are taken out of the equations.
void fix_tilt(NormalEquations& equations) {
  for (int axis = 0; axis < 2; ++axis) {
    equations.information.row(axis).setZero();
    equations.information.col(axis).setZero();
    equations.information(axis, axis) = 1;
    equations.gradient[axis] = 0;
  }
}

// Far below what any scanner resolves in a voxel.
bool is_small(const Vector6& step, double voxel_size) {
  return step.head<3>().norm() < 3e-5 && step.tail<3>().norm() < 3e-4 * voxel_size;
}

template <typename Solver>
bool is_solvable(const Solver& solver) {
  return solver.info() == Eigen::Success && solver.isPositive() && solver.rcond() > 1e-12;
}

}  // namespace

Eigen::Vector3d Surface::normal(std::size_t i) const {
  if (states_.empty() || states_[i].load(std::memory_order_acquire) == known) return normals_[i];
  Eigen::Vector3d normal = local_normal(grid_, points_[i].cast<float>(), normal_radius_);
  // Threads that ask at the same time compute the same; one of them keeps it.
  State state = unknown;
  if (states_[i].compare_exchange_strong(state, being_kept)) {
    normals_[i] = normal;
    states_[i].store(known, std::memory_order_release);
  }
  return normal;
}

Transformation refine_point_to_plane(const Surface& source, const Surface& target, const Transformation& initial,
                                     const PointToPlaneOptions& options) {
  Transformation pose = initial;
  Partners partners(source.size(), -1);
  double loss_scale = 0;
  const std::size_t steps = options.radii.size() + options.max_last_steps;
  for (std::size_t k = 0; k < steps; ++k) {
    const bool is_early = k + 1 < options.radii.size();
    const double radius = options.radii[is_early ? k : options.radii.size() - 1] * options.voxel_size;
    NormalEquations equations =
        linearise(source, target, pose, 1, radius, is_early || k == 0 ? 0.5 * radius : loss_scale,
                  is_early ? options.early_points : options.max_points, options.threads, &partners);
    if (equations.pairs < min_pairs) break;
    loss_scale =
        loss_scale_of(equations.residual_variance(), options.radii.back() * options.voxel_size, options.voxel_size);
    if (options.degrees_of_freedom == 4) fix_tilt(equations);
    const Eigen::LDLT<Matrix6> solver(equations.information.topLeftCorner<6, 6>());
    if (!is_solvable(solver)) break;
    const Vector6 step = solver.solve(-equations.gradient.head<6>());
    pose = motion(step, equations.centre) * pose;
    pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
    if (!is_early && is_small(step, options.voxel_size)) break;
  }
  return pose;
}

ScaleFit fit_scale(const Surface& source, const Surface& target, const Transformation& initial,
                   const PointToPlaneOptions& options) {
  ScaleFit fit{1, std::numeric_limits<double>::infinity(), initial};
  for (const double radius : options.radii) {
    NormalEquations equations =
        linearise(source, target, fit.target_from_source, fit.factor, radius * options.voxel_size,
                  0.5 * radius * options.voxel_size, options.max_points, options.threads);
    if (equations.pairs < min_pairs) break;
    if (options.degrees_of_freedom == 4) fix_tilt(equations);
    const Eigen::LDLT<Matrix7> solver(equations.information);
    if (!is_solvable(solver)) break;
    const Vector7 step = solver.solve(-equations.gradient);
    const double growth = std::exp(std::clamp(step[6], -max_growth, max_growth));
    Transformation& pose = fit.target_from_source;
    pose.translation() = equations.centre + growth * (pose.translation() - equations.centre);
    pose = motion(step.head<6>(), equations.centre) * pose;
    pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
    fit.factor *= growth;
    fit.sigma = fit.factor * std::sqrt(equations.residual_variance() * solver.solve(Vector7::Unit(6))[6]);
  }
  return fit;
}

Linearisation linearise_at(const Surface& source, const Surface& target, const Transformation& pose, double radius,
                           std::size_t max_points, int threads, double loss_scale) {
  const NormalEquations equations =
      linearise(source, target, pose, 1, radius, loss_scale > 0 ? loss_scale : 0.5 * radius, max_points, threads);
  return {equations.centre, equations.information.topLeftCorner<6, 6>(), equations.gradient.head<6>(),
          equations.residual_variance(), equations.pairs};
}

double loss_scale_of(double residual_variance, double radius, double voxel_size) {
  const double most = 0.5 * radius;
  return std::clamp(loss_sigmas * std::sqrt(residual_variance), std::min(least_loss_scale * voxel_size, most), most);
}

std::vector<PlanePair> plane_pairs_at(const Surface& source, const Surface& target, const Transformation& pose,
                                      double radius, std::size_t max_points, int threads) {
  const Sample sample(source, max_points);
  std::vector<std::vector<PlanePair>> parts((sample.size + block - 1) / block);
  parallel_blocks(parts.size(), threads, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      visit_pairs(source, target, pose, 1, radius, sample, k * block, (k + 1) * block, nullptr,
                  [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& n) {
                    parts[k].push_back({p, n, n.dot(p - q)});
                  });
    }
  });
  std::vector<PlanePair> pairs;
  for (const std::vector<PlanePair>& part : parts) pairs.insert(pairs.end(), part.begin(), part.end());
  return pairs;
}

}  // namespace igsp
