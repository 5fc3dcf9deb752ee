#include "registration/mirror_image.hpp"

#include "features/extraction.hpp"
#include "registration/search.hpp"

namespace igsp {
namespace {

constexpr double beyond_doubt = 0.9;

// What a search for the mirrored source would answer. It has no right pose, so this is what wrong poses of this very
// pair can reach; unless it is the source that is mirrored.
Result answer_for_mirror_image(const Features& source, const Features& target, const CompleteBoth& complete_both,
                               const Options& options, StageClock& clock) {
  clock.start("mirror image");
  Features image = mirrored_features(source, options);
  const CompleteBoth complete_image = [&](StageClock& at) {
    complete_both(at);
    complete(options, at, image);
  };
  const ProgressCallback keep_asking = [&](const Progress&) {
    clock.report(0.5);  // throws where the caller wants to stop
    return true;
  };
  StageClock own(keep_asking);
  ScaleLadder scales(image, target, complete_image, options, own);
  const SearchOutcome outcome = hypotheses_search(scales, options, own);
  Result result;
  result.options = options;
  judge(scales, outcome, result);
  return result;
}

// Of mirrored real scans the most confident answer has 0.86. Where free space speaks for it, simulated ones reach 0.97,
// on surfaces that touch at up to 0.90: those of right poses of such confidence nearly all do at more.
bool is_beyond_doubt(const Result& result) {
  constexpr double lying = 0.92;
  const FreeSpace& space = result.evidence.free_space;
  return result.confidence >= beyond_doubt &&
         ((!space.source && !space.target) || result.evidence.contact_share >= lying);
}

}  // namespace

void compare_with_mirror_image(const Features& source, const Features& target, const CompleteBoth& complete_both,
                               StageClock& clock, Doubts& doubts, Result& result) {
  if (result.confidence < 0.5 || is_beyond_doubt(result)) return;
  const Result image = answer_for_mirror_image(source, target, complete_both, result.options, clock);
  if (image.confidence > result.confidence) {
    result.confidence /= result.confidence + image.confidence;  // less than a half
  } else if (image.confidence >= beyond_doubt && image.evidence.quality > result.evidence.quality) {
    result.confidence /= 2;  // rivals take from the confidence of the better one
  } else {
    return;
  }
  doubts.mirror_image_fits = true;
}

}  // namespace igsp
