#include "network/runners_up.hpp"

#include <algorithm>
#include <memory>

#include "igsp/align.hpp"
#include "network/decide.hpp"
#include "network/pairs.hpp"

namespace igsp {
namespace {

// From the network's own pose; what the refinement of the runner-up makes up for.
constexpr double near_enough = 3;  // [voxels]

// Between scans that nothing brings together: as hard to tell from the best pose, and of a pair that shares something.
constexpr double least_share_of_best = 0.5, least_confidence_of_best = 0.05;

bool agrees_with(const Network& network, const NetworkLink& link, const Transformation& target_from_source,
                 const ScanShape& source) {
  return displacement(network, link.source, link.target, target_from_source, source) < near_enough * network.voxel_size;
}

bool is_worth_a_look(const Network& network, const NetworkLink& link, std::span<const ScanShape> shapes) {
  if (is_used(link) || !link.runner_up) return false;
  const std::size_t a = network.scans[link.source].component, b = network.scans[link.target].component;
  if (a == b) return agrees_with(network, link, link.runner_up->target_from_source, shapes[link.source]);
  return link.runner_up->share >= least_share_of_best && link.confidence >= least_confidence_of_best &&
         network.components[a].size() + network.components[b].size() > 2;
}

// No more probable than the best pose leaves it; by itself it confirms nothing.
NetworkLink second_look(const NetworkLink& first, bool joined, const Features& source, const Features& target,
                        const Options& options) {
  NetworkLink link =
      link_of({first.source, first.target}, align(source, target, first.runner_up->target_from_source, options));
  link.origin = LinkOrigin::runner_up;
  link.runner_up.reset();
  link.confidence = std::min(link.confidence, 1 - first.confidence);
  link.state = joined ? LinkState::unconfirmed : LinkState::not_registered;
  link.reason = "the second best pose" + std::string(joined ? ", which is that of the network: " : ": ") + link.reason;
  return link;
}

}  // namespace

std::vector<NetworkLink> runners_up(const Network& network, FeatureShelf& features, std::span<const ScanShape> shapes,
                                    const NetworkOptions& options) {
  Options single = options.pair;
  single.threads = 1;
  std::vector<NetworkLink> found;
  for (const NetworkLink& link : network.links) {
    if (link.origin != LinkOrigin::pair || !is_worth_a_look(network, link, shapes)) continue;
    const std::shared_ptr<const Features> source = features.get(link.source), target = features.get(link.target);
    const bool joined = network.scans[link.source].component == network.scans[link.target].component;
    if (!joined && !(source->viewpoint && target->viewpoint)) continue;  // nobody could bear witness
    const NetworkLink again = second_look(link, joined, *source, *target, single);
    if (joined && !agrees_with(network, again, again.target_from_source, shapes[again.source])) continue;
    found.push_back(again);
  }
  return found;
}

}  // namespace igsp
