#pragma once

#include <span>
#include <vector>

#include "igsp/network.hpp"
#include "network/feature_shelf.hpp"

namespace igsp {

/// Fine registration of all scans of a component at once: point-to-plane between the surfaces of every link that is
/// used, one sparse system for all poses, so that the last scan of a loop lies as well as the first. Moves the poses of
/// `network` and gives them covariances from the surfaces' residuals. `stations` by scan, see control.hpp. Components
/// that lie where their control has them, by `under_control`, move as a whole, too, and are held by it.
void refine_jointly(Network& network, FeatureShelf& features, std::span<const Eigen::Vector3d> stations,
                    const NetworkOptions& options, const std::vector<bool>& under_control);

}  // namespace igsp
