#pragma once

#include "igsp/features.hpp"
#include "igsp/result.hpp"
#include "registration/range_image.hpp"
#include "spatial/point_grid.hpp"

namespace igsp {

/// A cloud's voxels, and what its scanner saw from where it stood. Refers to the features.
class ScannedSpace {
 public:
  explicit ScannedSpace(const Features& features);

  /// How `moved` contradicts what this scanner saw; nothing where its viewpoint is not known. Looks at an even
  /// selection of about as many voxels.
  std::optional<FreeSpaceViolation> violation_by(const ScannedSpace& moved, const Transformation& this_from_moved,
                                                 std::size_t most_looks) const;

 private:
  struct Seen {
    PointGrid surface;  // of the voxels
    RangeImage image;
  };
  const Features& features_;
  std::optional<Seen> seen_;  // where the viewpoint is known
};

/// The third question to a pose: the scanners saw through this space, so is it empty? Both directions, of those whose
/// viewpoint is known.
FreeSpace free_space(const ScannedSpace& source, const ScannedSpace& target, const Transformation& target_from_source,
                     std::size_t most_looks = 1000);

/// What that says of the pose, as log10 odds that it is right; exactly 0 where no viewpoint is known. `source` and
/// `target`: of the rung that asks. docs/verdict.md tells how the numbers were found.
double free_space_evidence(const FreeSpace& free_space, const Features& source, const Features& target);

}  // namespace igsp
