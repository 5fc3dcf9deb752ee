#pragma once

#include <deque>
#include <functional>
#include <optional>

#include "core/stage_clock.hpp"
#include "registration/common_frame.hpp"
#include "registration/free_space.hpp"
#include "registration/precision.hpp"

namespace igsp {

/// Fills what the features of both clouds may lack, where that is needed.
using CompleteBoth = std::function<void(StageClock&)>;

/// Both clouds at the voxels that were chosen, rung 0, and at voxels twice as large on every further rung: sparse
/// surfaces close there, and searching costs a quarter. Each is made ready where it is first asked for: most pairs that
/// overlap are settled above rung 0. Refers to the features.
class ScaleLadder {
 public:
  /// `complete` fills what extract_features was told to leave out of both, as stages of the clock; what the other rungs
  /// take is one more.
  ScaleLadder(const Features& source, const Features& target, CompleteBoth complete, const Options& options,
              StageClock& clock);

  std::size_t rungs() const { return rungs_.size(); }  ///< at least one; none where too few voxels would be left
  int threads() const { return options_.threads; }
  double voxel_size(std::size_t rung) const { return rungs_[rung].target.voxel_size; }
  CommonFrame& frame(std::size_t rung);

  FineSurfaces& fine_surfaces();  ///< what the fine registration works on

  /// What the scanners saw through, asked at rung 0 of every pose: larger voxels forgive a wrong pose whatever is but a
  /// few of them large.
  PairSpace& space() { return space_; }
  const PairSpace& space() const { return space_; }

  const Features& source() const { return rungs_[0].source; }  ///< of rung 0; complete only after frame(0)
  const Features& target() const { return rungs_[0].target; }

 private:
  struct Coarser {
    Features source, target;  // empty where the features have them
  };
  struct Clouds {
    Clouds(const Features& source_features, const Features& target_features, const Options& options);
    PreparedCloud source, target;
    CommonFrame frame;
  };
  struct Rung {
    const Features& source;
    const Features& target;
    std::optional<Clouds> clouds;
  };

  void complete_coarser(Coarser& pair);

  CompleteBoth complete_;
  const Options& options_;
  StageClock& clock_;
  std::deque<Coarser> coarser_;  // from rung 1 on
  std::deque<Rung> rungs_;
  std::optional<FineSurfaces> fine_surfaces_;
  PairSpace space_;
};

}  // namespace igsp
