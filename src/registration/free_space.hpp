#pragma once

#include "igsp/result.hpp"
#include "registration/prepared_cloud.hpp"

namespace igsp {

/// How `moved` contradicts what the scanner of `fixed` saw; nothing where its viewpoint is not known. Looks at an even
/// selection of voxels.
std::optional<FreeSpaceViolation> free_space_violation(const PreparedCloud& moved, const PreparedCloud& fixed,
                                                       const Transformation& fixed_from_moved);

/// The third question to a pose: the scanners saw through this space, so is it empty? Both directions, of those whose
/// viewpoint is known.
FreeSpace free_space(const PreparedCloud& source, const PreparedCloud& target,
                     const Transformation& target_from_source);

/// What that says of the pose, as log10 odds that it is right; exactly 0 where no viewpoint is known. docs/verdict.md tells
/// how the numbers were found.
double free_space_evidence(const FreeSpace& free_space, const PreparedCloud& source, const PreparedCloud& target);

}  // namespace igsp
