#pragma once

#include "igsp/result.hpp"
#include "registration/point_to_plane.hpp"

namespace igsp {

/// Root mean square distance of a surface's points from their centroid: the length that makes a rotation of one radian
/// comparable with a translation.
double size_of(const Surface& surface);

/// Information, covariance and free directions of a pose from the normal equations at it.
Precision precision_of(const Linearisation& linearisation, double size);

/// Motions that slide a surface along itself (Gelfand et al. 2003): what no registration of it could fix. In the
/// surface's own frame.
std::vector<FreeDirection> slippable_motions(Surface& surface);

}  // namespace igsp
