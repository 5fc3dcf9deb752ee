#include "registration/mirror_image.hpp"

#include "features/extraction.hpp"
#include "registration/search.hpp"

namespace igsp {
namespace {

// How confident a search for the mirrored source would be. It has no right pose, so this is what wrong poses of this
// very pair can reach; unless it is the source that is mirrored.
double confidence_of_mirror_image(const Features& source, const Features& target, const CompleteBoth& complete_both,
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
  return result.confidence;
}

}  // namespace

void compare_with_mirror_image(const Features& source, const Features& target, const CompleteBoth& complete_both,
                               StageClock& clock, Doubts& doubts, Result& result) {
  constexpr double beyond_doubt = 0.9;  // mirrored real scans reach 0.86
  if (result.confidence < 0.5 || result.confidence >= beyond_doubt) return;
  const double of_image = confidence_of_mirror_image(source, target, complete_both, result.options, clock);
  if (of_image <= result.confidence) return;
  doubts.mirror_image_fits = true;
  result.confidence /= result.confidence + of_image;  // less than a half
}

}  // namespace igsp
