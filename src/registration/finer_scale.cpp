#include "registration/finer_scale.hpp"

namespace igsp {

FinerScale::Clouds::Clouds(const Features& source_features, const Features& target_features, const Options& options)
    : source(source_features),
      target(target_features),
      frame(source, target, options.descriptor.radius * target_features.voxel_size, options.threads) {}

FinerScale::FinerScale(const Features& source, const Features& target, std::function<void(StageClock&)> complete,
                       const Options& options, StageClock& clock)
    : source_(source), target_(target), complete_(std::move(complete)), options_(options), clock_(clock) {}

CommonFrame& FinerScale::frame() {
  if (!clouds_) {
    complete_(clock_);
    clouds_.emplace(source_, target_, options_);
  }
  return clouds_->frame;
}

}  // namespace igsp
