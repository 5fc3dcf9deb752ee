#include "simulation/bounding_volume_hierarchy.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "simulation/random.hpp"

namespace igsp::simulation {
namespace {

using Eigen::Vector3d;

Primitives random_primitives(int count, Random& random) {
  Primitives primitives;
  for (int i = 0; i < count; ++i) {
    const Vector3d p = 3.0 * random.normal_vector(), u = 0.5 * random.normal_vector(), v = 0.5 * random.normal_vector();
    const Vector3d radii = u.cwiseAbs() + Vector3d::Constant(0.01);
    switch (random.integer(0, 3)) {
      case 0:
        primitives.push_back(Triangle{p, u, v});
        break;
      case 1:
        primitives.push_back(Parallelogram{p, u, v});
        break;
      case 2:
        primitives.push_back(make_ellipsoid(p, random.rotation(), radii));
        break;
      default:
        primitives.push_back(make_frustum(p, p + u, 0.3, 0.1));
    }
  }
  return primitives;
}

double nearest_of_all(const Primitives& primitives, const Ray& ray) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Primitive& primitive : primitives) nearest = std::min(nearest, first_crossing(primitive, ray));
  return nearest;
}

TEST(BoundingVolumeHierarchy, FindsTheHitThatTryingAllPrimitivesFinds) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    const Primitives primitives = random_primitives(random.integer(1, 300), random);
    const BoundingVolumeHierarchy hierarchy(primitives);
    for (int i = 0; i < 50; ++i) {
      const Vector3d origin = 4.0 * random.normal_vector();
      const Ray ray{origin, i % 5 == 0 ? Vector3d(Vector3d::Unit(i / 5 % 3)) : random.direction()};
      const Hit hit = hierarchy.first_hit(ray);
      RC_ASSERT(hit.distance == nearest_of_all(primitives, ray));
      if (hit) RC_ASSERT(first_crossing(hierarchy.primitives()[hit.primitive], ray) == hit.distance);
    }
  }));
}

TEST(BoundingVolumeHierarchy, SurvivesNoPrimitiveAndManyInOnePlace) {
  EXPECT_FALSE(BoundingVolumeHierarchy(Primitives{}).first_hit({Vector3d::Zero(), Vector3d::UnitX()}));
  const Primitive sphere = make_ellipsoid({5, 0, 0}, Eigen::Matrix3d::Identity(), {1, 1, 1});
  const BoundingVolumeHierarchy hierarchy(Primitives(1000, sphere));
  EXPECT_DOUBLE_EQ(hierarchy.first_hit({Vector3d::Zero(), Vector3d::UnitX()}).distance, 4.0);
}

TEST(BoundingVolumeHierarchy, StopsAtTheMaximalDistance) {
  const BoundingVolumeHierarchy hierarchy({make_ellipsoid({5, 0, 0}, Eigen::Matrix3d::Identity(), {1, 1, 1})});
  EXPECT_TRUE(hierarchy.first_hit({Vector3d::Zero(), Vector3d::UnitX()}, 4.1));
  EXPECT_FALSE(hierarchy.first_hit({Vector3d::Zero(), Vector3d::UnitX()}, 3.9));
}

}  // namespace
}  // namespace igsp::simulation
