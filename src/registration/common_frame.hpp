#pragma once

#include <cmath>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "estimation/rigid_fit.hpp"
#include "features/support.hpp"
#include "igsp/result.hpp"
#include "registration/prepared_cloud.hpp"

namespace igsp {

/// At which of the source's keypoints: at a first look at 45 to 90 of them, evenly chosen.
enum class Look { first, whole };

/// Descriptors of both clouds' keypoints in ONE frame, the target's axes: given a hypothesis of the rotation, no local
/// reference frame is left that could fail to repeat. Descriptors of the target are computed once, where they are first
/// asked for, those of the source are kept with their rotation and reused within 2 degrees. Several threads may use
/// it at once for rotations that are described already.
class CommonFrame {
 public:
  CommonFrame(const PreparedCloud& source, const PreparedCloud& target, double descriptor_radius, int threads);

  /// What rotations will be asked for, of which of the source's keypoints, and what angle off will do.
  void describe(std::span<const Transformation> target_from_source, Look look = Look::whole,
                double reuse_angle_rad = default_reuse_angle_rad);
  const std::vector<Descriptor>& target_descriptors();
  /// After a first look only those of every `first_look_step` are defined.
  const std::vector<Descriptor>& source_descriptors(const Eigen::Matrix3d& target_from_source, Look look = Look::whole,
                                                    double reuse_angle_rad = default_reuse_angle_rad);
  std::size_t first_look_step() const;  ///< 1: there are so few keypoints that all are looked at

  const PreparedCloud& source() const { return source_; }
  const PreparedCloud& target() const { return target_; }
  double descriptor_radius() const { return descriptor_radius_; }
  int threads() const { return threads_; }

 private:
  static constexpr double default_reuse_angle_rad = 2.0 * M_PI / 180.0;

  struct Cached {
    Eigen::Matrix3d rotation;
    Look look;  // what is described of it
    std::vector<Descriptor> descriptors;
  };
  Cached* known(const Eigen::Matrix3d& target_from_source, Look look, double reuse_angle_rad);
  const SupportTable& source_supports();
  void describe_source(std::span<const Eigen::Matrix3d> target_from_source, Look look, double reuse_angle_rad);

  const PreparedCloud& source_;
  const PreparedCloud& target_;
  double descriptor_radius_;
  int threads_;
  std::optional<SupportTable> source_supports_;
  std::optional<std::vector<Descriptor>> target_descriptors_;
  std::deque<Cached> cache_;
};

/// Mutual nearest neighbours by feature distance in the common frame of a rotation.
std::vector<PointPair> mutual_matches(CommonFrame& frame, const Eigen::Matrix3d& target_from_source, int threads,
                                      Look look = Look::whole);

/// A hypothesis after matching again in its common frame.
struct Rematch {
  Transformation target_from_source;
  std::vector<PointPair> matches;  ///< mutual nearest neighbours
  std::size_t agreeing = 0;        ///< of them, within 2.5 voxels
  FreeSpace free_space;            ///< at the pose, where it was asked
};

/// Matches again, votes for the translation (mode of b - R a) and fits robustly; keeps the better of both poses.
Rematch rematch(CommonFrame& frame, const Transformation& hypothesis, int degrees_of_freedom, int threads,
                Look look = Look::whole);

/// With the same matches, but fitted where the hypothesis is: among like rooms the vote may go to another one.
Rematch fit_in_place(const CommonFrame& frame, const Transformation& hypothesis, std::vector<PointPair> matches,
                     int degrees_of_freedom);

}  // namespace igsp
