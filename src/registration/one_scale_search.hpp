#pragma once

#include <span>
#include <vector>

#include "core/stage_clock.hpp"
#include "registration/rivals.hpp"
#include "registration/scale_ladder.hpp"

namespace igsp {

/// Proposes poses on a rung of the ladder, screens them and ranks the best, together with those that a coarser rung
/// found. Best first; at least one, unless nothing was proposed. Where none of them is hopeful, fewer are looked into.
std::vector<Rival> search_at(ScaleLadder& scales, std::size_t rung, std::span<const Rival> found, Options options,
                             StageClock& clock);

/// What contradicts the poses that were found says nothing of those that were not.
double quality_without_free_space(const Rival& pose);

/// Whether a pose may yet turn out right, or be the rival of one that does.
bool is_hopeful(const Rival& pose);

}  // namespace igsp
