#pragma once

#include <vector>

#include "igsp/features.hpp"
#include "igsp/result.hpp"
#include "registration/range_image.hpp"
#include "spatial/point_grid.hpp"

namespace igsp {

/// A cloud's voxels, and what its scanner saw from where it stood. Refers to the features.
class ScannedSpace {
 public:
  explicit ScannedSpace(const Features& features);

  bool is_known() const { return seen_.has_value(); }

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

/// What it says of a pose, as log10 odds that it is right; exactly 0 where no viewpoint is known. `rarity`: how rare it
/// is among wrong poses of the pair to be contradicted as little [decades]. `voxels`: of a cloud on the rung that asks.
/// docs/verdict.md tells how the numbers were found.
double free_space_evidence(const FreeSpace& free_space, double rarity, double voxels);

/// The third question to the poses of a pair: the scanners saw through this space, so is it empty? Both directions, of
/// those whose viewpoint is known. Refers to the features.
class PairSpace {
 public:
  PairSpace(const Features& source, const Features& target) : source_(source), target_(target) {}

  bool is_known() const { return source_.is_known() || target_.is_known(); }

  FreeSpace at(const Transformation& target_from_source, std::size_t most_looks = 1000) const {
    return {target_.violation_by(source_, target_from_source, most_looks),
            source_.violation_by(target_, target_from_source.inverse(), most_looks)};
  }

  /// Of a pose that was proposed. Nearly all of them are wrong, so they tell what it is worth that one is hardly
  /// contradicted: nothing in a corridor, much in a furnished room.
  void note_proposal(const FreeSpace& free_space) { proposed_.push_back(free_space.violation()); }

  /// With the rarity among what was proposed.
  double evidence(const FreeSpace& free_space, double voxels) const;

 private:
  ScannedSpace source_, target_;
  std::vector<double> proposed_;  // violations
};

}  // namespace igsp
