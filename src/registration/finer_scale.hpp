#pragma once

#include <functional>
#include <optional>

#include "core/stage_clock.hpp"
#include "registration/common_frame.hpp"

namespace igsp {

/// Both clouds at the voxels that were chosen, made ready where that is first asked for: the coarser scale settles most
/// pairs that overlap. Refers to the features.
class FinerScale {
 public:
  /// `complete` fills what extract_features was told to leave out of both, as stages of the clock.
  FinerScale(const Features& source, const Features& target, std::function<void(StageClock&)> complete,
             const Options& options, StageClock& clock);

  const Features& source() const { return source_; }  ///< complete only after frame()
  const Features& target() const { return target_; }
  CommonFrame& frame();

 private:
  struct Clouds {
    Clouds(const Features& source_features, const Features& target_features, const Options& options);
    PreparedCloud source, target;
    CommonFrame frame;
  };
  const Features& source_;
  const Features& target_;
  std::function<void(StageClock&)> complete_;
  const Options& options_;
  StageClock& clock_;
  std::optional<Clouds> clouds_;
};

}  // namespace igsp
