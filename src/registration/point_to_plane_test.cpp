#include "registration/point_to_plane.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/core_testing.hpp"
#include "igsp/evaluation.hpp"

namespace igsp {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using testing::BumpySurface;
using testing::Random;

constexpr double voxel_size = 0.1;

Surface surface_of(const Points& points) {
  return Surface(points, PointGrid(points, voxel_size), 3 * voxel_size);
}

// Places so far apart that each has one partner, and their normals.
struct Places {
  Points p, q, p_normals, q_normals;
};

Places random_places(Random& random, std::size_t count) {
  Places places;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p(static_cast<double>(i % 8), static_cast<double>(i / 8), random.uniform(0, 3));
    const Eigen::Vector3d normal = random.direction();
    places.p.push_back(p);
    places.q.push_back(p + random.in_cube(0.1));
    places.p_normals.push_back(normal);
    places.q_normals.push_back((normal + random.in_cube(0.2)).normalized() * (i % 2 ? 1 : -1));
  }
  return places;
}

TEST(PointToPlane, NormalEquationsAreThoseOfTheDefinition) {
  Random random(1);
  const Places places = random_places(random, 64);
  Surface source(places.p, PointGrid(places.p, 1), places.p_normals);
  Surface target(places.q, PointGrid(places.q, 1), places.q_normals);
  const double radius = 0.3, scale = radius / 2;
  const Linearisation at_pose = linearise_at(source, target, Transformation::Identity(), radius, 1000);

  std::vector<double> residuals, weights;
  Points normals;
  double weight_sum = 0, squares = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < places.p.size(); ++i) {
    const double sign = places.p_normals[i].dot(places.q_normals[i]) < 0 ? -1 : 1;
    normals.push_back((places.p_normals[i] + sign * places.q_normals[i]).normalized());
    residuals.push_back(normals[i].dot(places.p[i] - places.q[i]));
    weights.push_back(std::pow(1 + std::pow(residuals[i] / scale, 2), -2));
    weight_sum += weights[i];
    squares += weights[i] * residuals[i] * residuals[i];
    centre += weights[i] * places.p[i];
  }
  centre /= weight_sum;
  Matrix6 hessian = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  for (std::size_t i = 0; i < places.p.size(); ++i) {
    // A rotation by r moves p by r x (p - c), along n by r . ((p - c) x n).
    Vector6 jacobian;
    jacobian << (places.p[i] - centre).cross(normals[i]), normals[i];
    hessian += weights[i] * jacobian * jacobian.transpose();
    gradient += weights[i] * residuals[i] * jacobian;
  }
  EXPECT_EQ(at_pose.pairs, places.p.size());
  EXPECT_LT((at_pose.centre - centre).norm(), 1e-12);
  EXPECT_LT((at_pose.hessian - hessian).norm(), 1e-9 * hessian.norm());
  EXPECT_LT((at_pose.gradient - gradient).norm(), 1e-9);
  EXPECT_NEAR(at_pose.residual_variance, squares / weight_sum, 1e-12);
}

constexpr std::array<double, 6> radii{3, 3, 2, 2, 1, 1};

PointToPlaneOptions options_of(int degrees_of_freedom) {
  return {.early_points = 2000,
          .max_points = 2000,
          .radii = radii,
          .max_last_steps = 20,
          .voxel_size = voxel_size,
          .degrees_of_freedom = degrees_of_freedom};
}

// The source is the target itself, moved away, so that the truth is the only minimum.
struct Scene {
  Points target_points, source_points;
  Transformation truth;

  Scene(std::uint64_t seed, const Transformation& target_from_source) : truth(target_from_source) {
    Random random(seed);
    target_points = BumpySurface(random).sample(random, 2000, 1);
    source_points = testing::moved(truth.inverse(), target_points);
  }
  PoseError error_of(const Transformation& found) const { return pose_error(found, truth, source_points.front()); }
};

TEST(PointToPlane, FindsTheTruthFromNearby) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Random random(seed + 100);
    const Scene scene(seed, random.motion(5));
    const Transformation off(Eigen::Translation3d(random.in_cube(0.05)) * Eigen::AngleAxisd(0.03, random.direction()));
    Surface source = surface_of(scene.source_points), target = surface_of(scene.target_points);
    const PoseError error = scene.error_of(refine_point_to_plane(source, target, off * scene.truth, options_of(6)));
    EXPECT_LT(error.rotation_rad, 1e-6) << "seed " << seed;
    EXPECT_LT(error.centroid_displacement, 1e-6) << "seed " << seed;
  }
}

// The surfaces are new each time, so that the threads ask for normals that are not known yet.
TEST(PointToPlane, SameBitsForEveryThreadCount) {
  Random random(11);
  const Scene scene(12, random.motion(5));
  const Transformation start = Eigen::AngleAxisd(0.02, random.direction()) * scene.truth;
  std::vector<Transformation> found;
  for (const int threads : {1, 2, 4}) {
    const Surface source = surface_of(scene.source_points), target = surface_of(scene.target_points);
    PointToPlaneOptions options = options_of(6);
    options.threads = threads;
    found.push_back(refine_point_to_plane(source, target, start, options));
  }
  EXPECT_EQ(found[1].matrix(), found[0].matrix());
  EXPECT_EQ(found[2].matrix(), found[0].matrix());
}

TEST(PointToPlane, LevelledFindsTheYawAndTouchesNoTilt) {
  const Scene scene(7, Transformation(Eigen::Translation3d(3, -2, 1) * Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ())));
  const Transformation off(Eigen::Translation3d(0.04, 0.02, -0.03) * Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitZ()));
  Surface source = surface_of(scene.source_points), target = surface_of(scene.target_points);
  const Transformation found = refine_point_to_plane(source, target, off * scene.truth, options_of(4));
  EXPECT_LT(scene.error_of(found).rotation_rad, 1e-6);
  EXPECT_LT(scene.error_of(found).centroid_displacement, 1e-6);

  const Transformation tilted = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitX()) * scene.truth;
  const Transformation kept = refine_point_to_plane(source, target, tilted, options_of(4));
  EXPECT_LT((kept.linear().row(2) - tilted.linear().row(2)).norm(), 1e-12) << "what a yaw leaves alone";
}

// A board above bumpy ground, thinner than the search is wide: each cloud has seen one side of it. The sides are as
// near as what is matched, but the ground says that they are not the same.
TEST(PointToPlane, TheOtherSideOfAThinThingPullsLittle) {
  Random random(21);
  const BumpySurface ground(random);
  Points source_points = ground.sample(random, 4000, 2), target_points = source_points;
  const double thickness = 0.5 * voxel_size;
  for (int i = 0; i < 300; ++i) {
    source_points.emplace_back(0, random.uniform(-1, 1), random.uniform(3, 4));
    target_points.emplace_back(thickness, random.uniform(-1, 1), random.uniform(3, 4));
  }
  const Surface source = surface_of(source_points), target = surface_of(target_points);
  PointToPlaneOptions options = options_of(6);
  options.early_points = options.max_points = source_points.size();
  const Transformation found = refine_point_to_plane(source, target, Transformation::Identity(), options);
  EXPECT_LT(found.translation().norm(), 0.02 * thickness);
}

// A wall between two rooms, and ground under both that fixes little along its normal: where it is known who saw what,
// the other side of the wall is not taken for this one.
TEST(PointToPlane, TheTwoSidesOfAWallDoNotPull) {
  Random random(23);
  const double thickness = 1.4 * voxel_size;
  Points front, back;
  for (int i = 0; i < 4000; ++i) {
    const double y = random.uniform(-1, 1), z = random.uniform(0, 2);
    front.emplace_back(0, y, z);
    back.emplace_back(thickness, y + 0.3 * voxel_size, z);
  }
  const BumpySurface ground(random);
  for (const Eigen::Vector3d& point : ground.sample(random, 500, 2)) {
    front.push_back(point - Eigen::Vector3d(0, 0, 1));
    back.push_back(point - Eigen::Vector3d(0, 0, 1));
  }
  const auto seen_from = [](const Points& points, double x) {
    return Surface(points, PointGrid(points, voxel_size), 3 * voxel_size, Viewpoints(Eigen::Vector3d(x, 0, 1)));
  };
  const Surface source = seen_from(front, -3), target = seen_from(back, 3), beside = seen_from(back, -3);
  PointToPlaneOptions options = options_of(6);
  options.early_points = options.max_points = front.size();
  const Transformation truth = Transformation::Identity();
  EXPECT_LT(refine_point_to_plane(source, target, truth, options).translation().norm(), 0.02 * thickness);
  EXPECT_GT(refine_point_to_plane(source, beside, truth, options).translation().norm(), 0.3 * thickness);
  EXPECT_GT(refine_point_to_plane(surface_of(front), target, truth, options).translation().norm(), 0.3 * thickness);
}

// Lines of a scanner with few of them, those of one cloud between those of the other: the surfaces are the same, no
// line is.
TEST(PointToPlane, ScanLinesFindTheSurfaceAndNotEachOther) {
  Random random(22);
  const BumpySurface ground(random);
  const auto lines = [&](double first) {
    Points points;
    for (double y = first; y < 2; y += 4 * voxel_size) {
      for (double x = -2; x < 2; x += 0.3 * voxel_size) points.emplace_back(x, y, ground.height_at(x, y));
    }
    return points;
  };
  const Points source_points = lines(-2), target_points = lines(-2 + 2 * voxel_size);
  const auto surface_of_lines = [](const Points& points) {
    return Surface(points, PointGrid(points, voxel_size), 1.5 * voxel_size);
  };
  const Surface source = surface_of_lines(source_points), target = surface_of_lines(target_points);
  const Transformation off(Eigen::Translation3d(random.in_cube(0.05)) * Eigen::AngleAxisd(0.02, random.direction()));
  PointToPlaneOptions options = options_of(6);
  constexpr std::array<double, 6> wide{6, 5, 4, 3, 3, 3};
  options.radii = wide;
  const Transformation found = refine_point_to_plane(source, target, off, options);
  const PoseError error = pose_error(found, Transformation::Identity(), Eigen::Vector3d::Zero());
  EXPECT_LT(error.rotation_rad, 0.01);
  EXPECT_LT(error.centroid_displacement, 0.2 * voxel_size);
}

TEST(PointToPlane, TheLossFollowsTheResidualsWithinWhatVoxelsAndRadiusAllow) {
  EXPECT_DOUBLE_EQ(loss_scale_of(0.1 * 0.1, 2, 1), 0.3);
  EXPECT_DOUBLE_EQ(loss_scale_of(0, 2, 1), 0.15);
  EXPECT_DOUBLE_EQ(loss_scale_of(5, 2, 1), 1);
  EXPECT_DOUBLE_EQ(loss_scale_of(5, 0.1, 1), 0.05) << "a radius below what voxels resolve";
}

// Growth about any place but the centre of the pairs would move a cloud that stands far from its origin away.
TEST(PointToPlane, FindsTheScaleOfACloudFarFromItsOrigin) {
  Random random(9);
  const Transformation truth(Eigen::Translation3d(-40, 25, 30) * Eigen::AngleAxisd(0.4, random.direction()));
  const Scene scene(8, truth);
  const double factor = 1.04;
  Points small = scene.source_points;
  for (Eigen::Vector3d& point : small) point /= factor;
  // At this start the middle of the small cloud lies where it belongs.
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : small) middle += point / static_cast<double>(small.size());
  Transformation start = truth;
  start.translation() += truth.linear() * (factor * middle - middle);
  Surface source = surface_of(small), target = surface_of(scene.target_points);
  const ScaleFit fit = fit_scale(source, target, start, options_of(6));
  EXPECT_NEAR(fit.factor, factor, 1e-4);
  EXPECT_LT((fit.target_from_source * (fit.factor * small[0]) - scene.target_points[0]).norm(), 1e-2 * voxel_size);
  EXPECT_LT(fit.sigma, 1e-3);
}

}  // namespace
}  // namespace igsp
