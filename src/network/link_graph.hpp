#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "network/small_motion.hpp"

namespace igsp {

/// A registered pair as the network weighs it; lengths in voxels.
struct GraphLink {
  std::size_t source = 0, target = 0;
  Transformation target_from_source = Transformation::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the steps below, in the target's frame
  Matrix6 information = Matrix6::Identity();         ///< how much the link pulls
  Matrix6 tolerance = Matrix6::Identity();  ///< covariance of what it may be off and still be right: it judges loops
  double weight = 1;                        ///< of its vote
  bool may_stand_alone = true;              ///< joins scans without a loop that confirms it
  /// Or at least with so many witnesses: other scans that it brings together and that say so (WitnessQuestion).
  std::optional<std::size_t> witnesses_needed;
  bool confirms_nothing = false;  ///< in no loop that would: refused as a pair, or a second look at what was tried
  bool is_doubtful = false;       ///< something speaks against it: it does not confirm others like it
};

/// Scans (their centres, in their own frames) and links.
struct LinkGraph {
  std::vector<Eigen::Vector3d> centres;
  std::vector<GraphLink> links;
  int degrees_of_freedom = 6;  ///< of the scans; 4: they are levelled, and stay so
};

/// A link followed from source to target, or back.
struct LinkStep {
  std::size_t link;
  bool forward;
};

/// Squared error in sigmas of a chain of links that ends where it begins: chi-square of 6 degrees of freedom under the
/// links' tolerances.
double loop_error(const LinkGraph& graph, std::span<const LinkStep> loop);

/// Beyond it a loop or a link is wrong: 99 % of chi-square with 6 degrees of freedom.
inline constexpr double max_loop_error = 16.8;

}  // namespace igsp
