#include "diagnosis/mirrored.hpp"

#include <fmt/format.h>

#include <cmath>

#include "features/extraction.hpp"
#include "igsp/align.hpp"
#include "registration/scale_votes.hpp"

namespace igsp {
namespace {

// Pairs that would register have votes for the scale 1 at this prominence, nearly all of them, and others seldom.
constexpr double mirrored_prominence = 5.0;
constexpr double largest_vote_error = 0.08;  // of the logarithm: a vote is no measurement

}  // namespace

std::optional<Diagnosis> mirrored(const SearchedPair& pair, const ProgressCallback& progress) {
  const Features image = mirrored_features(pair.source, pair.options);
  const RatioPeak vote = scale_vote(image, pair.target, 1.0, pair.options);
  if (vote.prominence < mirrored_prominence || std::abs(std::log(vote.factor)) > largest_vote_error)
    return std::nullopt;
  const Result result = align(image, pair.target, pair.options, progress);
  if (!result.registered) return std::nullopt;

  Eigen::Matrix4d target_from_source = result.target_from_source.matrix();
  target_from_source.col(0) *= -1;  // as mirrored_features does
  return Diagnosis{Cause::mirrored,
                   fmt::format("the mirrored source would register (confidence {:.3f}): one of the clouds is "
                               "left-handed; negate one of its axes or exchange two, unless the scene itself is "
                               "symmetric",
                               result.confidence),
                   target_from_source};
}

}  // namespace igsp
