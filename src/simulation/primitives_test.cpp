#include "simulation/primitives.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "simulation/random.hpp"

namespace igsp::simulation {
namespace {

using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();

Primitives one_of_each(Random& random) {
  const Vector3d u = random.normal_vector(), v = random.normal_vector(), p = random.normal_vector();
  const Eigen::Isometry3d at = Eigen::Translation3d(random.normal_vector()) * Eigen::Isometry3d(random.rotation());
  const Vector3d size = random.normal_vector().cwiseAbs() + Vector3d::Constant(0.1), end = p + v;
  const double r0 = random.uniform(0.0, 1.0), r1 = random.uniform(0.0, 1.0);
  return {Triangle{p, u, v}, Parallelogram{p, u, v}, make_box(at, u, size), make_ellipsoid(p, random.rotation(), size),
          make_frustum(p, end, r0, r1)};
}

TEST(Primitives, RayMeetsKnownSurfaces) {
  const Ray down{{0.1, 0.2, 5.0}, {0.0, 0.0, -1.0}};
  const Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
  EXPECT_DOUBLE_EQ(first_crossing(Triangle{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, down), 4.0);
  EXPECT_EQ(first_crossing(Triangle{{-1, -1, 1}, {1, 0, 0}, {0, 1, 0}}, down), infinity);
  EXPECT_DOUBLE_EQ(first_crossing(Parallelogram{{-1, -1, 1}, {2, 0, 0}, {0, 2, 0}}, down), 4.0);
  EXPECT_DOUBLE_EQ(first_crossing(make_box(at, {0, 0, 1}, {2, 4, 6}), down), 1.0);
  EXPECT_DOUBLE_EQ(first_crossing(make_ellipsoid({0.1, 0.2, 0}, Eigen::Matrix3d::Identity(), {1, 2, 3}), down), 2.0);
  EXPECT_DOUBLE_EQ(first_crossing(make_frustum({0, 0, 0}, {0, 0, 2}, 1.0, 0.5), down), 3.0);       // cap
  EXPECT_DOUBLE_EQ(first_crossing(make_frustum({-9, 0.2, 0}, {9, 0.2, 0}, 1.0, 1.0), down), 4.0);  // side
}

TEST(Primitives, SurfacesAreSeenFromInsideToo) {
  const Ray up{Vector3d::Zero(), Vector3d::UnitZ()};
  const Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
  EXPECT_DOUBLE_EQ(first_crossing(make_box(at, Vector3d::Zero(), {2, 4, 6}), up), 3.0);
  EXPECT_DOUBLE_EQ(first_crossing(make_ellipsoid({0, 0, 0}, Eigen::Matrix3d::Identity(), {1, 2, 3}), up), 3.0);
  EXPECT_DOUBLE_EQ(first_crossing(make_frustum({0, 0, -1}, {0, 0, 2}, 1.0, 0.5), up), 2.0);
}

TEST(Primitives, CrossingsLieWithinTheBounds) {
  Random random(1);
  int crossings = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d origin = 5.0 * random.direction(), aim = random.normal_vector();
    const Ray ray{origin, (aim - origin).normalized()};
    for (const Primitive& primitive : one_of_each(random)) {
      const double distance = first_crossing(primitive, ray);
      if (distance == infinity) continue;
      ++crossings;
      EXPECT_GT(distance, 0.0);
      EXPECT_LT(bounds(primitive).exteriorDistance(ray.origin + distance * ray.direction), 1e-9) << primitive.index();
    }
  }
  EXPECT_GT(crossings, 1000);
}

// Three parallel rays that meet one smooth patch span its tangent plane, whatever the formula of the normal.
TEST(Primitives, NormalIsPerpendicularToTheSurfaceThatTheRaysFeel) {
  Random random(2);
  int tested = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d origin = 5.0 * random.direction(), direction = (random.normal_vector() - origin).normalized();
    const Vector3d side = 1e-6 * direction.unitOrthogonal(), other_side = direction.cross(side);
    for (const Primitive& primitive : one_of_each(random)) {
      const auto meet = [&](const Vector3d& from) {
        return Vector3d(from + first_crossing(primitive, {from, direction}) * direction);
      };
      const Vector3d a = meet(origin), b = meet(origin + side), c = meet(origin + other_side);
      if (!a.allFinite() || !b.allFinite() || !c.allFinite()) continue;
      const Vector3d felt = (b - a).cross(c - a).normalized(), normal = normal_at(primitive, a);
      EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
      if ((b - a).norm() > 1e-5 || (c - a).norm() > 1e-5) continue;  // grazing, or across an edge
      EXPECT_NEAR(std::abs(felt.dot(normal)), 1.0, 1e-3) << primitive.index();
      ++tested;
    }
  }
  EXPECT_GT(tested, 300);
}

TEST(Random, IsTheSameOnEveryMachineAndLooksNormal) {
  EXPECT_EQ(Random(7).bits(), 12716562659884567161u);
  EXPECT_NE(Random(7).bits(), Random(8).bits());
  EXPECT_NE(Random(7, 0).bits(), Random(7, 1).bits());
  Random random(7);
  double sum = 0.0, squares = 0.0;
  const int count = 100000;
  for (int i = 0; i < count; ++i) {
    const double value = random.normal();
    sum += value, squares += value * value;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.02);
  EXPECT_NEAR(squares / count, 1.0, 0.02);
}

}  // namespace
}  // namespace igsp::simulation
