#pragma once

#include <span>
#include <vector>

#include "igsp/features.hpp"

namespace igsp {

/// The descriptors by which a scan is likened to others: a few, those of its most curved keypoints.
std::vector<Descriptor> voters_of(const Features& scan);

/// How much more alike two scans are than either is to the rest, by the voters of both alone. Row-major, scans x scans,
/// symmetric; about 0.5 for scans that do not overlap. Of no use below three scans.
std::vector<double> likeness_of_scans(std::span<const std::vector<Descriptor>> scans, int degrees_of_freedom,
                                      int threads);

}  // namespace igsp
