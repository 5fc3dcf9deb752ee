#include "registration/coarser_scale.hpp"

#include <algorithm>
#include <string>

#include "features/extraction.hpp"

namespace igsp {
namespace {

constexpr int stages = 4;                 // keypoints and descriptors of both
constexpr std::size_t min_voxels = 1200;  // at the finer scale: a quarter of them is left

}  // namespace

CoarserScale::Clouds::Clouds(Features source_of, Features target_of, const Options& options)
    : source_features(std::move(source_of)),
      target_features(std::move(target_of)),
      source(source_features),
      target(target_features),
      frame(source, target, options.descriptor.radius * target_features.voxel_size, options.threads) {}

bool CoarserScale::is_there() const {
  return std::min(source_.points.size(), target_.points.size()) >= min_voxels;
}

CommonFrame& CoarserScale::frame() {
  if (clouds_) return clouds_->frame;
  std::string stage;
  int begun = 0;
  const ProgressCallback report = [&](const Progress& progress) {
    if (progress.stage != stage) ++begun, stage = progress.stage;
    clock_.report((begun - 1 + progress.fraction) / stages);
    return true;
  };
  Features source = coarser_features(source_, options_, report);
  clouds_.emplace(std::move(source), coarser_features(target_, options_, report), options_);
  return clouds_->frame;
}

}  // namespace igsp
