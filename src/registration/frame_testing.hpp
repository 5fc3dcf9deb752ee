// Shared by the tests of what happens in a common frame.
#pragma once

#include "core/core_testing.hpp"
#include "registration/common_frame.hpp"

namespace igsp::testing {

inline Options frame_options() {
  Options options;
  options.threads = 1;
  options.scale.voxel_size = 0.1;
  options.keypoints.suppression_radius = 3;
  return options;
}

/// What of a bumpy surface both clouds hold, in units of length.
struct Extent {
  double half_side = 4;
  double common = 8;  ///< width of the strip that both see, all of it by default
};

/// A bumpy surface and a moved resampling of it.
struct Scene {
  Transformation truth;
  Features source, target;
  PreparedCloud prepared_source, prepared_target;

  explicit Scene(std::uint64_t seed, Extent extent = {}) : Scene(Random(seed), extent) {}

  CommonFrame frame(int threads = 1) const {
    return CommonFrame(prepared_source, prepared_target, frame_options().descriptor.radius * 0.1, threads);
  }

 private:
  // Braces: in this order, whatever the compiler.
  explicit Scene(Random random, Extent extent) : Scene{random, random.motion(3), BumpySurface(random), extent} {}
  Scene(Random& random, const Transformation& motion, const BumpySurface& shape, Extent extent)
      : truth(motion),
        source(extract_features(seen_from(-1, shape, random, extent), frame_options())),
        target(extract_features(moved(motion, seen_from(1, shape, random, extent)), frame_options())),
        prepared_source(source),
        prepared_target(target) {
    truth.translation() += truth.linear() * source.origin - target.origin;  // between the centred clouds
  }
  /// Without what lies too far on the other side.
  static Points seen_from(double side, const BumpySurface& shape, Random& random, Extent extent) {
    const auto points = static_cast<std::size_t>(1250 * extent.half_side * extent.half_side);
    Points seen = shape.sample(random, points, extent.half_side);
    std::erase_if(seen, [&](const Eigen::Vector3d& p) { return side * p.x() < -0.5 * extent.common; });
    return seen;
  }
};

}  // namespace igsp::testing
