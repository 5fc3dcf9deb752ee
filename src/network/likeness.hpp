#pragma once

#include <span>
#include <vector>

#include "igsp/features.hpp"

namespace igsp {

/// How much more alike two scans are than either is to the rest, by their descriptors alone: votes of some keypoints of
/// both. Row-major, scans x scans, symmetric; about 0.5 for scans that do not overlap. Of no use below three scans.
std::vector<double> likeness_of_scans(std::span<const Features* const> scans, int degrees_of_freedom, int threads);

}  // namespace igsp
