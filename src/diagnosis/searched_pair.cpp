#include "diagnosis/searched_pair.hpp"

#include <algorithm>

namespace igsp {
namespace {

constexpr int max_proposed = 12, max_refined = 2;
constexpr std::size_t enough_to_coarsen = 4000;

Options options_for(const Result& refused) {
  Options options = refused.options;
  const bool coarser = std::min(refused.source.voxels, refused.target.voxels) >= enough_to_coarsen;
  options.scale.voxel_size = (coarser ? 2 : 1) * refused.voxel_size;
  options.hypotheses.max_proposed = std::min(options.hypotheses.max_proposed, max_proposed);
  options.hypotheses.max_refined = std::min(options.hypotheses.max_refined, max_refined);
  return options;
}

}  // namespace

SearchedPair::SearchedPair(const Scan& source_scan, const Scan& target_scan, const Result& refused,
                           const ProgressCallback& progress)
    : options(options_for(refused)),
      source(extract_features(source_scan, options, progress)),
      target(extract_features(target_scan, options, progress)) {}

}  // namespace igsp
