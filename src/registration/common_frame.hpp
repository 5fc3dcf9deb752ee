#pragma once

#include <vector>

#include "estimation/rigid_fit.hpp"
#include "features/support.hpp"
#include "registration/prepared_cloud.hpp"

namespace igsp {

/// Descriptors of both clouds' keypoints in ONE frame, the target's axes: given a hypothesis of the rotation, no local
/// reference frame is left that could fail to repeat. Descriptors of the target are computed once, those of the source
/// are kept with their rotation and reused within 2 degrees.
class CommonFrame {
 public:
  CommonFrame(const PreparedCloud& source, const PreparedCloud& target, double descriptor_radius, int threads);

  const std::vector<Descriptor>& target_descriptors() const { return target_descriptors_; }
  /// Valid until the next call.
  const std::vector<Descriptor>& source_descriptors(const Eigen::Matrix3d& target_from_source);

  /// Of one cloud's keypoints in any axes, the columns of a rotation.
  std::vector<Descriptor> describe_source(const Eigen::Matrix3d& axes) const;
  std::vector<Descriptor> describe_target(const Eigen::Matrix3d& axes) const;

  const PreparedCloud& source() const { return source_; }
  const PreparedCloud& target() const { return target_; }
  double descriptor_radius() const { return descriptor_radius_; }
  int threads() const { return threads_; }

 private:
  struct Cached {
    Eigen::Matrix3d rotation;
    std::vector<Descriptor> descriptors;
  };
  const PreparedCloud& source_;
  const PreparedCloud& target_;
  double descriptor_radius_;
  int threads_;
  SupportTable source_supports_, target_supports_;
  std::vector<Descriptor> target_descriptors_;
  std::vector<Cached> cache_;
};

/// Mutual nearest neighbours by feature distance in the common frame of a rotation.
std::vector<PointPair> mutual_matches(CommonFrame& frame, const Eigen::Matrix3d& target_from_source);

/// The same between descriptors that are there.
std::vector<PointPair> mutual_nearest(const CommonFrame& frame, std::span<const Descriptor> source,
                                      std::span<const Descriptor> target);

/// The translation that most matches vote for: of b - R a the one with most others within `radius`, averaged over them.
struct TranslationMode {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  std::size_t votes = 0;
};
TranslationMode translation_mode(std::span<const PointPair> matches, const Eigen::Matrix3d& rotation, double radius);

/// A hypothesis after matching again in its common frame.
struct Rematch {
  Transformation target_from_source;
  std::vector<PointPair> matches;  ///< mutual nearest neighbours
  std::size_t agreeing = 0;        ///< of them, within 2.5 voxels
};

/// Matches again, votes for the translation (mode of b - R a) and fits robustly; keeps the better of both poses.
Rematch rematch(CommonFrame& frame, const Transformation& hypothesis, int degrees_of_freedom);

}  // namespace igsp
