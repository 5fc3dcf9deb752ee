#include "features/bsc.hpp"
#include "registration/igsp_loop.hpp"
#include "registration/precision.hpp"
#include "registration/search.hpp"

namespace igsp {

SearchOutcome direct_search(const CommonFrame& frame, const Options& options, StageClock& clock) {
  clock.start("loop");
  const int variants = options.degrees_of_freedom == 4 ? 2 : 4;
  const std::vector<Descriptor> source_variants = sign_variants(frame.source().features.descriptors, variants);
  const LoopInput input{frame.source().keypoints,
                        frame.target().keypoints,
                        source_variants,
                        variants,
                        frame.target().features.descriptors,
                        frame.target().features.voxel_size};
  LoopSchedule schedule;
  schedule.max_iterations = options.convergence.max_iterations;
  const double share = 1.0 / schedule.max_iterations;
  LoopOutcome loop = igsp_loop(input, Transformation::Identity(), schedule, options,
                               [&](int iteration) { clock.report(share * iteration); });
  SearchOutcome outcome;
  outcome.termination = loop.termination;
  outcome.has_estimate = loop.has_estimate;
  outcome.target_from_source = loop.target_from_source;
  outcome.iterations = std::move(loop.iterations);
  if (outcome.has_estimate) {
    const FineSurfaces surfaces(frame.source().features, frame.target().features, options.threads);
    outcome.precision = precision_at(surfaces, outcome.target_from_source, options.degrees_of_freedom);
  }
  return outcome;
}

}  // namespace igsp
