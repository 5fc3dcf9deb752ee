#include "registration/scale_ladder.hpp"

#include <algorithm>
#include <string>

#include "core/concurrently.hpp"
#include "core/parallel.hpp"
#include "features/extraction.hpp"

namespace igsp {
namespace {

constexpr int stages = 4;  // keypoints and descriptors of both

}  // namespace

ScaleLadder::Clouds::Clouds(const Features& source_features, const Features& target_features, const Options& options)
    : source(source_features),
      target(target_features),
      frame(source, target, options.descriptor.radius * target_features.voxel_size, options.threads) {}

ScaleLadder::ScaleLadder(const Features& source, const Features& target, CompleteBoth complete, const Options& options,
                         StageClock& clock)
    : complete_(std::move(complete)), options_(options), clock_(clock), space_(source, target) {
  rungs_.push_back({source, target, {}});
  while (rungs_.size() < most_scales) {
    const Rung& below = rungs_.back();
    if (std::min(below.source.points.size(), below.target.points.size()) < enough_voxels_for_coarser) break;
    const std::size_t k = coarser_.size();
    Coarser& made = coarser_.emplace_back();
    const auto coarser = [k](const Features& features, const Features& finer, Features& own) -> const Features& {
      if (k < features.coarser.size()) return features.coarser[k];
      return own = coarser_voxels(finer);
    };
    const Features *of_source = nullptr, *of_target = nullptr;
    parallel_pair(
        options.threads, [&] { of_source = &coarser(source, below.source, made.source); },
        [&] { of_target = &coarser(target, below.target, made.target); });
    rungs_.push_back({*of_source, *of_target, {}});
  }
}

void ScaleLadder::complete_coarser(Coarser& pair) {
  if (pair.source.points.empty() && pair.target.points.empty()) return;
  clock_.start("coarser scale");
  std::string stage;
  int begun = 0;
  double done = 0;
  const ProgressCallback report = [&](const Progress& progress) {
    if (progress.stage != stage) ++begun, stage = progress.stage;
    done = std::clamp((begun - 1 + progress.fraction) / stages, done, 1.0);
    clock_.report(done);
    return true;
  };
  const auto complete_one = [&](Features& features) {
    return [&](const ProgressCallback& progress) {
      StageClock own(progress);
      complete(options_, own, features);
      own.finish();
    };
  };
  concurrently(options_.threads, report, complete_one(pair.source), complete_one(pair.target));
}

CommonFrame& ScaleLadder::frame(std::size_t rung) {
  auto& [source, target, clouds] = rungs_[rung];
  if (!clouds) {
    if (rung == 0) {
      complete_(clock_);
    } else {
      complete_coarser(coarser_[rung - 1]);
    }
    clouds.emplace(source, target, options_);
  }
  return clouds->frame;
}

FineSurfaces& ScaleLadder::fine_surfaces() {
  if (!fine_surfaces_) fine_surfaces_.emplace(source(), target(), options_.threads);
  return *fine_surfaces_;
}

}  // namespace igsp
