#pragma once

#include <functional>
#include <span>
#include <vector>

#include "registration/common_frame.hpp"
#include "registration/hypotheses.hpp"

namespace igsp {

/// Is the space empty that the scanners saw through, if a pose is right? Not given where no viewpoint is known.
using FreeSpaceQuestion = std::function<FreeSpace(const Transformation&)>;

/// What the quality of a pose has of its matches and of free space, in decades.
double promise_of(const Rematch& match);

/// Matches proposals again in their common frame, in the light of free space where that is known. A clear winner spares
/// the others, except those with half of its inliers, which would be the other poses of a symmetric scene. Where the
/// first three have no winner, the others get a first look, and only the best quarter of them is matched again before
/// it is asked whether there is any hope.
class Screening {
 public:
  /// Refers to all of them.
  Screening(CommonFrame& frame, std::span<const Hypothesis> hypotheses, const Options& options,
            const FreeSpaceQuestion& ask_free_space);

  /// Called first, once. `tick`: the share that is done.
  std::vector<Rematch> most_promising(const std::function<void(double)>& tick);
  bool has_put_off() const { return !put_off_.empty(); }
  std::vector<Rematch> put_off();  ///< called at most once: what the first look put off, matched again

 private:
  std::vector<Rematch> match(std::span<const Hypothesis> batch);
  std::vector<Hypothesis> best_at_first_look(std::span<const Hypothesis> others);

  CommonFrame& frame_;
  std::span<const Hypothesis> hypotheses_;
  int degrees_of_freedom_;
  const FreeSpaceQuestion& ask_free_space_;
  std::size_t winner_inliers_ = 0;
  std::vector<Hypothesis> put_off_;
};

}  // namespace igsp
