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

/// A bumpy surface and a moved resampling of it.
struct Scene {
  Transformation truth;
  Features source, target;
  PreparedCloud prepared_source, prepared_target;

  explicit Scene(std::uint64_t seed) : Scene(Random(seed)) {}

  CommonFrame frame(int threads = 1) const {
    return CommonFrame(prepared_source, prepared_target, frame_options().descriptor.radius * 0.1, threads);
  }

 private:
  explicit Scene(Random random) : Scene(random, BumpySurface(random), random.motion(3)) {}
  Scene(Random& random, const BumpySurface& shape, const Transformation& motion)
      : truth(motion),
        source(extract_features(shape.sample(random, 20000, 4), frame_options())),
        target(extract_features(moved(motion, shape.sample(random, 20000, 4)), frame_options())),
        prepared_source(source),
        prepared_target(target) {
    truth.translation() += truth.linear() * source.origin - target.origin;  // between the centred clouds
  }
};

}  // namespace igsp::testing
