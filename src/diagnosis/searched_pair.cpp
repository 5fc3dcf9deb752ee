#include "diagnosis/searched_pair.hpp"

#include <algorithm>

#include "core/concurrently.hpp"
#include "features/extraction.hpp"

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
    : options(options_for(refused)) {
  const auto extract = [&](const Scan& scan, Features& features) {
    return [&](const ProgressCallback& report) {
      features = extract_features(TrimmedScan(scan, "cloud"), options, report, Described::at_one_scale);
    };
  };
  concurrently(options.threads, progress, extract(source_scan, source), extract(target_scan, target));
}

}  // namespace igsp
