#include "network/pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include "core/parallel.hpp"
#include "igsp/align.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

constexpr std::size_t slice = 8;  // pairs at once, between two reports

// Of the direction that is seen less of. Nothing where voxels above 2 v answered: what they match is too little for a
// link to stand alone by, or for one that was refused to look clear.
std::size_t in_view(const Result& result) {
  if (result.evidence.voxel_size > 2 * result.voxel_size) return 0;
  const FreeSpace& space = result.evidence.free_space;
  return space.source && space.target ? std::min(space.source->in_view, space.target->in_view) : 0;
}

// A pair that nobody has registered yet, with what it takes.
struct OpenPair {
  std::size_t number;  // among those that were asked for
  std::shared_ptr<const Features> source, target;
};

}  // namespace

NetworkLink link_of(const ScanPair& pair, const Result& result) {
  NetworkLink link;
  link.source = pair.first;
  link.target = pair.second;
  link.state = result.registered ? LinkState::unconfirmed : LinkState::not_registered;
  link.reason = result.reason;
  link.target_from_source = result.target_from_source;
  link.confidence = result.confidence;
  link.overlap = result.overlap();
  link.rmse = result.rmse;
  link.mutual_matches = result.evidence.mutual_matches;
  link.agreeing_matches = result.evidence.agreeing_matches;
  link.violation = result.evidence.free_space.violation();
  link.in_view = in_view(result);
  link.precision = result.precision;
  link.runner_up = result.runner_up;
  return link;
}

std::vector<ScanPair> all_pairs(const std::vector<NetworkScan>& scans) {
  std::vector<ScanPair> pairs;
  for (std::size_t source = 1; source < scans.size(); ++source) {
    for (std::size_t target = 0; target < source; ++target) {
      if (scans[source].problem.empty() && scans[target].problem.empty()) pairs.emplace_back(source, target);
    }
  }
  return pairs;
}

std::vector<ScanPair> listed_pairs(const std::vector<NetworkScan>& scans, std::span<const ScanPair> given) {
  std::set<ScanPair> pairs;
  for (const auto& [a, b] : given) {
    if (a >= scans.size() || b >= scans.size() || a == b) {
      throw InvalidArgument(fmt::format("a pair of scans {} and {} is listed; expected two different ones of 0 to {}",
                                        a, b, scans.size() - 1));
    }
    if (scans[a].problem.empty() && scans[b].problem.empty()) pairs.emplace(std::max(a, b), std::min(a, b));
  }
  return {pairs.begin(), pairs.end()};
}

std::vector<NetworkLink> register_pairs(std::span<const ScanPair> pairs, FeatureShelf& features, const Options& options,
                                        const PairStore& store, const std::function<void(double)>& report) {
  if (store.prepare) store.prepare(pairs, report);
  Options single = options;
  single.threads = 1;
  std::vector<NetworkLink> links(pairs.size());
  std::vector<OpenPair> open;
  const auto register_open = [&] {
    parallel_blocks(open.size(), options.threads, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const ScanPair& pair = pairs[open[i].number];
        const Result result = align(*open[i].source, *open[i].target, single);
        if (store.keep) store.keep(pair.first, pair.second, result);
        links[open[i].number] = link_of(pair, result);
      }
    });
    open.clear();
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [source, target] = pairs[i];
    if (open.empty()) report(static_cast<double>(i) / static_cast<double>(pairs.size()));
    if (const std::optional<Result> found = store.find ? store.find(source, target) : std::nullopt) {
      links[i] = link_of(pairs[i], *found);
      continue;
    }
    open.push_back({i, features.get(source), features.get(target)});
    if (open.size() == slice) register_open();
  }
  register_open();
  return links;
}

}  // namespace igsp
