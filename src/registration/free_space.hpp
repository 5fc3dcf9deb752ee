#pragma once

#include <vector>

#include "igsp/features.hpp"
#include "igsp/result.hpp"
#include "registration/range_image.hpp"
#include "spatial/point_grid.hpp"

namespace igsp {

/// A cloud's voxels, and what its scanners saw from where they stood: one, or one a part. Refers to the features.
class ScannedSpace {
 public:
  explicit ScannedSpace(const Features& features);

  bool is_known() const { return !images_.empty(); }

  /// How `moved` contradicts what these scanners saw: a place is in view if one of them saw it, and empty if one saw
  /// through it. Nothing where no viewpoint is known. Looks at an even selection of about as many voxels.
  std::optional<FreeSpaceViolation> violation_by(const ScannedSpace& moved, const Transformation& this_from_moved,
                                                 std::size_t most_looks) const;

  /// Of about as many voxels of `moved`, those that lie on the surface here. 0 where no viewpoint is known.
  std::size_t met_by(const ScannedSpace& moved, const Transformation& this_from_moved, std::size_t most_looks) const;

 private:
  enum class Sight { out_of_view, possible, contradicts };
  Sight look_at(const Eigen::Vector3d& point) const;
  bool is_on_surface(const Eigen::Vector3d& point, double growth) const;

  const Features& features_;
  std::vector<RangeImage> images_;    // of the parts whose viewpoint is known
  std::optional<PointGrid> surface_;  // of the voxels, where any is known
};

/// Both directions, of those whose viewpoint is known.
inline FreeSpace free_space_between(const ScannedSpace& source, const ScannedSpace& target,
                                    const Transformation& target_from_source, std::size_t most_looks = 1000) {
  return {target.violation_by(source, target_from_source, most_looks),
          source.violation_by(target, target_from_source.inverse(), most_looks)};
}

/// What free space says of a pose, as log10 odds that it is right; exactly 0 where no viewpoint is known. `rarity`: how
/// rare it is among wrong poses of the pair to be contradicted as little [decades]. `weight`: of what that confirms,
/// [0, 1]. docs/verdict.md tells how the numbers were found.
double free_space_evidence(const FreeSpace& free_space, double rarity, double weight);
constexpr double usual_rarity = 1;  ///< one in ten, where no proposals tell

/// The third question to the poses of a pair: the scanners saw through this space, so is it empty? Both directions, of
/// those whose viewpoint is known. Refers to the features.
class PairSpace {
 public:
  PairSpace(const Features& source, const Features& target) : source_(source), target_(target) {}

  bool is_known() const { return source_.is_known() || target_.is_known(); }

  bool is_known_of_both() const { return source_.is_known() && target_.is_known(); }

  FreeSpace at(const Transformation& target_from_source, std::size_t most_looks = 1000) const {
    return free_space_between(source_, target_, target_from_source, most_looks);
  }

  /// Of a pose that was proposed. Nearly all of them are wrong, so they tell what it is worth that one is hardly
  /// contradicted: nothing in a corridor, much in a furnished room.
  void note_proposal(const FreeSpace& free_space) { proposed_.push_back(free_space.violation()); }

  /// With the rarity among what was proposed, or the usual one where nothing was, as from an initial guess.
  double evidence(const FreeSpace& free_space, double weight) const;

 private:
  ScannedSpace source_, target_;
  std::vector<double> proposed_;  // violations
};

}  // namespace igsp
