#include "network/survey_free_space.hpp"

#include <algorithm>
#include <cmath>

#include "features/scale_lengths.hpp"
#include "network/components.hpp"
#include "network/measured_graph.hpp"
#include "registration/free_space.hpp"

namespace igsp {
namespace {

// Scans far apart see little of each other, and a share of little proves little.
constexpr std::size_t least_in_view = 100;

bool says_no(const std::optional<FreeSpaceViolation>& violation) {
  return violation && violation->in_view >= least_in_view && violation->share() > forbidden_violation;
}

// The links in no loop, as a forest of what they join.
struct Bridges {
  std::vector<std::size_t> links;
  std::vector<Edge> edges;
};

Bridges bridges_of(const Network& network) {
  Bridges found;
  for (std::size_t l = 0; l < network.links.size(); ++l) {
    if (network.links[l].state != LinkState::unconfirmed) continue;
    found.links.push_back(l);
    found.edges.emplace_back(network.links[l].source, network.links[l].target);
  }
  return found;
}

// Where every scan lies if one of the links in no loop is taken away.
std::vector<std::size_t> sides_without(const Network& network, std::size_t taken) {
  std::vector<Edge> edges;
  for (std::size_t l = 0; l < network.links.size(); ++l) {
    const NetworkLink& link = network.links[l];
    if (l == taken || (link.state != LinkState::used && link.state != LinkState::unconfirmed)) continue;
    edges.emplace_back(link.source, link.target);
  }
  std::vector<std::size_t> side(network.scans.size());
  const auto components = connected_components(network.scans.size(), edges);
  for (std::size_t c = 0; c < components.size(); ++c) {
    for (const std::size_t i : components[c]) side[i] = c;
  }
  return side;
}

}  // namespace

SurveyFreeSpace::SurveyFreeSpace(std::span<const Features* const> features, double voxel_size)
    : features_(features),
      unit_(voxel_size > 0 ? std::ldexp(1.0, std::ilogb(voxel_size)) : 1.0),
      scaled_(features.size()),
      prepared_(features.size()) {}

// In a unit near the voxel size, where single precision is at home.
const PreparedCloud& SurveyFreeSpace::prepared(std::size_t scan) {
  if (!prepared_[scan]) {
    scaled_[scan] = *features_[scan];
    scale_lengths(scaled_[scan], 1 / unit_);
    prepared_[scan].emplace(scaled_[scan]);
  }
  return *prepared_[scan];
}

std::optional<std::size_t> SurveyFreeSpace::contradicted_link(const Network& network) {
  const Bridges bridges = bridges_of(network);
  std::vector<std::size_t> by_confidence = bridges.links;
  std::stable_sort(by_confidence.begin(), by_confidence.end(), [&](std::size_t a, std::size_t b) {
    return network.links[a].confidence < network.links[b].confidence;
  });
  for (const std::size_t link : by_confidence) {
    const std::vector<std::size_t> side = sides_without(network, link);
    const std::size_t a = side[network.links[link].source], b = side[network.links[link].target];
    for (std::size_t i = 0; i < side.size(); ++i) {
      for (std::size_t j = 0; j < side.size(); ++j) {
        if (side[i] != a || side[j] != b || !(features_[i]->viewpoint || features_[j]->viewpoint)) continue;
        const PreparedCloud &one = prepared(i), &other = prepared(j);
        Transformation other_from_one = network.scans[j].world_from_scan.inverse() * network.scans[i].world_from_scan;
        other_from_one.translation() = (other_from_one * features_[i]->origin - features_[j]->origin) / unit_;
        const FreeSpace space = free_space(one, other, other_from_one);
        if (says_no(space.source) || says_no(space.target)) return link;
      }
    }
  }
  return {};
}

}  // namespace igsp
