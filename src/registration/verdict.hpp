#pragma once

#include "igsp/result.hpp"
#include "registration/search.hpp"

namespace igsp {

/// Of a pose that may look right, where something else says that it is not known or not possible; at most.
inline constexpr double confidence_of_what_cannot_be = 0.1;

/// What speaks against a pose besides the numbers of the result.
struct Doubts {
  bool is_ambiguous = false;         ///< more by other poses than by chance
  bool is_coarse = false;            ///< large voxels carry it and fine ones do not: it is not as good as it must be
  bool mirror_image_fits = false;    ///< better: the source is mirrored, or the scene is like its mirror image
  bool is_of_another_scale = false;  ///< no rigid motion puts such a source where it belongs
};

/// Fills confidence, evidence, overlap and RMSE of `result` from the pose that a search found; the reason is left to
/// `give_reason`. Where the scale that answered does not carry it, the others are asked as well: sparse surfaces close
/// at the coarser ones.
Doubts judge(ScaleLadder& scales, const SearchOutcome& outcome, Result& result);

}  // namespace igsp
