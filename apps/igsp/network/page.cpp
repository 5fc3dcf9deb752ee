#include "network/page.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "igsp/version.hpp"
#include "report/page.hpp"
#include "report/scene.hpp"

namespace igsp::cli {
namespace {

// Most pairs of a large survey do not overlap; the page shows the more likely ones of them, links.csv all.
constexpr std::size_t most_refused = 500;

constexpr std::size_t most_rows = 200;  // of loops and of contradictions, the worst first; network.json has all

// Colours of distances end here [voxels]: of registered scans nearly all surfaces are closer.
constexpr double farthest_coloured = 0.5;
constexpr std::uint8_t no_other_scan = 255;

std::string bytes_of(const std::vector<float>& numbers) {
  std::vector<std::uint8_t> bytes;
  for (const float number : numbers) {
    const auto word = std::bit_cast<std::uint32_t>(number);
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
  }
  return base64(bytes);
}

// 0 to 254 in 254ths of the farthest that has a colour of its own.
Json distances_of(const DrawnScan& drawn, double voxel_size) {
  if (drawn.distances.empty()) return nullptr;
  std::vector<std::uint8_t> bytes;
  for (const float distance : drawn.distances) {
    const double share = std::min(1.0, distance / (farthest_coloured * voxel_size));
    bytes.push_back(std::isinf(distance) ? no_other_scan : static_cast<std::uint8_t>(std::lround(254.0 * share)));
  }
  return base64(bytes);
}

Json scan_entry(const Network& network, std::size_t i, const DrawnScan& drawn) {
  const NetworkScan& scan = network.scans[i];
  Json sigma = Json::array();
  for (int k = 0; k < 6; ++k) sigma.push_back(std::sqrt(std::max(0.0, scan.covariance(k, k))));
  return {{"name", scan.name},
          {"problem", scan.problem.empty() ? Json(nullptr) : Json(scan.problem)},
          {"points", scan.points},
          {"component", scan.component},
          {"world_from_scan", to_json(scan.world_from_scan)},
          {"sigma", sigma},
          {"station", row(drawn.station)},
          {"station_known", drawn.station_known},
          {"origin", row(drawn.origin)},
          {"points_drawn", bytes_of(drawn.points)},
          {"distances_drawn", distances_of(drawn, network.voxel_size)}};
}

// Standard deviations of the pair's translation along the target's axes: null where it was not determined, and of an
// axis along which a direction is free, which has no standard deviation.
Json translation_sigma(const Precision& precision) {
  constexpr double along = 0.1;  // of a unit length
  if (precision.covariance.isZero(0)) return nullptr;
  Json sigma = Json::array();
  for (int axis = 3; axis < 6; ++axis) {
    const bool is_free = std::ranges::any_of(precision.free_directions, [&](const FreeDirection& direction) {
      return std::abs(direction.motion[axis]) > along;
    });
    sigma.push_back(is_free ? Json(nullptr) : Json(std::sqrt(std::max(0.0, precision.covariance(axis, axis)))));
  }
  return sigma;
}

Json link_entry(const NetworkLink& link) {
  Json entry = link_summary(link), free = Json::array();
  for (const FreeDirection& direction : link.precision.free_directions) free.push_back(direction.description);
  entry["translation_sigma"] = translation_sigma(link.precision);
  entry["free_directions"] = std::move(free);
  return entry;
}

// Those that do not close first, then the worst of the others.
Json loops_of(const Network& network) {
  std::vector<NetworkCycle> cycles = network.cycles;
  std::ranges::stable_sort(cycles, [](const NetworkCycle& a, const NetworkCycle& b) {
    return a.closes != b.closes ? b.closes : a.error > b.error;
  });
  Json shown = Json::array();
  for (const NetworkCycle& cycle : std::span(cycles).first(std::min(most_rows, cycles.size()))) {
    shown.push_back(cycle_summary(cycle));
  }
  return {{"all", cycles.size()}, {"closing", std::ranges::count_if(cycles, &NetworkCycle::closes)}, {"shown", shown}};
}

Json contradictions_of(const Network& network) {
  Json shown = Json::array();
  const std::size_t count = std::min(most_rows, network.contradictions.size());
  for (const NetworkContradiction& pair : std::span(network.contradictions).first(count)) {
    shown.push_back(contradiction_summary(pair));
  }
  return {{"all", network.contradictions.size()}, {"shown", shown}};
}

// Of the links, the most confident first within a state; of the refused not all.
std::vector<const NetworkLink*> links_shown(const Network& network) {
  std::vector<const NetworkLink*> links;
  for (const NetworkLink& link : network.links) links.push_back(&link);
  std::ranges::stable_sort(links, [](const NetworkLink* a, const NetworkLink* b) {
    return a->state != b->state ? a->state < b->state : a->confidence > b->confidence;
  });
  std::size_t refused = 0;
  std::erase_if(links, [&](const NetworkLink* link) {
    return link->state == LinkState::not_registered && ++refused > most_refused;
  });
  return links;
}

Json data_of(const Network& network, const NetworkOptions& options, std::span<const DrawnScan> drawn) {
  Json scans = Json::array(), links = Json::array(), counts = Json::object(), summary = Json::array();
  for (std::size_t i = 0; i < network.scans.size(); ++i) scans.push_back(scan_entry(network, i, drawn[i]));
  for (const NetworkLink* link : links_shown(network)) links.push_back(link_entry(*link));
  for (const LinkState state :
       {LinkState::used, LinkState::unconfirmed, LinkState::rejected, LinkState::not_registered}) {
    counts[std::string(to_string(state))] =
        std::ranges::count_if(network.links, [&](const NetworkLink& link) { return link.state == state; });
  }
  std::istringstream lines(network_summary(network));
  for (std::string line; std::getline(lines, line);) summary.push_back(line);
  return {{"igsp", version},
          {"summary", summary},
          {"bundle_error", network.bundle_error},
          {"voxel_size", network.voxel_size},
          {"farthest_coloured", farthest_coloured * network.voxel_size},
          {"neighbour_reach", neighbour_reach * network.voxel_size},
          {"components", network.components},
          {"scans", scans},
          {"links", links},
          {"loops", loops_of(network)},
          {"contradictions", contradictions_of(network)},
          {"counts", counts},
          {"pairs_tried", pairs_tried(network)},
          {"options", to_json(options.pair)}};
}

}  // namespace

std::string network_page(const Network& network, const NetworkOptions& options, std::span<const DrawnScan> drawn) {
  return std::string(network_page_head) + inside_script(data_of(network, options, drawn)) +
         std::string(network_page_tail);
}

}  // namespace igsp::cli
