#pragma once

#include <span>
#include <vector>

#include "matching/geometric_consistency.hpp"

namespace igsp {

/// How strongly each candidate is supported by candidates that agree with it, which are supported themselves: the
/// leading eigenvector of the consistency graph, scaled to a largest entry of 1 (spectral matching, Leordeanu and
/// Hebert 2005). In [0, 1]; all 0 where no two candidates agree.
std::vector<double> consistency_weights(const ConsistencyGraph& graph);

/// The smooth term in the energy: Eq. 1 over the candidates, where a pair costs T_cd (1 - weight), less the more its
/// surroundings support it, and exactly solved as in every iteration. Returns the matched candidates, in their order.
/// `sources` and `targets`: numbers of keypoints.
std::vector<std::uint32_t> consistent_assignment(std::span<const Candidate> candidates, std::span<const double> weights,
                                                 std::size_t sources, std::size_t targets);

}  // namespace igsp
