#pragma once

#include <span>

#include "igsp/network.hpp"

namespace igsp {

/// Fine registration of all scans of a component at once: point-to-plane between the surfaces of every link that is
/// used, one sparse system for all poses, so that the last scan of a loop lies as well as the first. Moves the poses of
/// `network` and gives them covariances from the surfaces' residuals. `features` by scan.
void refine_jointly(Network& network, std::span<const Features* const> features, const Options& options);

}  // namespace igsp
