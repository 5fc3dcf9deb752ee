#pragma once

#include <optional>

#include "core/stage_clock.hpp"
#include "registration/common_frame.hpp"

namespace igsp {

/// Both clouds at voxels twice as large, made where they are first asked for: sparse surfaces close there, and
/// searching costs a quarter. Refers to the features it comes from.
class CoarserScale {
 public:
  /// Making them is reported as progress of the clock's stage.
  CoarserScale(const Features& source, const Features& target, const Options& options, const StageClock& clock)
      : source_(source), target_(target), options_(options), clock_(clock) {}

  bool is_there() const;  ///< not where a cloud would be left with too few voxels to say anything
  CommonFrame& frame();   ///< only where `is_there`

 private:
  struct Clouds {
    Clouds(Features source_of, Features target_of, const Options& options);
    Features source_features, target_features;
    PreparedCloud source, target;
    CommonFrame frame;
  };
  const Features& source_;
  const Features& target_;
  const Options& options_;
  const StageClock& clock_;
  std::optional<Clouds> clouds_;
};

}  // namespace igsp
