#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "igsp/version.hpp"
#include "network/outputs.hpp"

namespace igsp::cli {
namespace {

std::string short_name(const std::string& name) {
  return std::filesystem::path(name).stem().string();
}

std::size_t count(const Network& network, LinkState state) {
  return std::ranges::count_if(network.links, [&](const NetworkLink& link) { return link.state == state; });
}

bool is_pair(const NetworkLink& link) {
  return link.origin == LinkOrigin::pair;
}

bool is_registered_pair(const NetworkLink& link) {
  return is_pair(link) && link.state != LinkState::not_registered;
}

// "26 in one frame, 2 in another"
std::string groups(const Network& network) {
  std::string text;
  for (const std::vector<std::size_t>& component : network.components) {
    if (component.size() < 2) continue;
    text +=
        fmt::format("{}{} in {}", text.empty() ? "" : ", ", component.size(), text.empty() ? "one frame" : "another");
  }
  return text;
}

}  // namespace

Json link_summary(const NetworkLink& link) {
  return {{"source", link.source},
          {"target", link.target},
          {"state", to_string(link.state)},
          {"origin", to_string(link.origin)},
          {"merged", link.merged},
          {"reason", link.reason},
          {"confidence", link.confidence},
          {"overlap", link.overlap},
          {"rmse", link.rmse},
          {"mutual_matches", link.mutual_matches},
          {"agreeing_matches", link.agreeing_matches},
          {"violation", link.violation},
          {"consistent_triangles", link.consistent_triangles},
          {"cycle_error", link.cycle_error},
          {"residual", link.residual},
          {"median_distance", link.median_distance},
          {"rms_distance", link.rms_distance}};
}

Json cycle_summary(const NetworkCycle& cycle) {
  return {{"scans", cycle.scans}, {"error", cycle.error}, {"closes", cycle.closes}};
}

Json contradiction_summary(const NetworkContradiction& pair) {
  return {{"scans", pair.scans}, {"violation", pair.violation}};
}

std::size_t pairs_tried(const Network& network) {
  return std::ranges::count_if(network.links, is_pair);
}

Json network_json(const Network& network, const NetworkOptions& options) {
  Json scans = Json::array(), links = Json::array(), cycles = Json::array(), contradictions = Json::array();
  for (const NetworkScan& scan : network.scans) {
    scans.push_back({{"name", scan.name},
                     {"problem", scan.problem.empty() ? Json(nullptr) : Json(scan.problem)},
                     {"points", scan.points},
                     {"component", scan.component},
                     {"world_from_scan", to_json(scan.world_from_scan)},
                     {"control_residual", scan.control_residual ? Json(*scan.control_residual) : Json(nullptr)},
                     {"centre", row(scan.centre)},
                     {"covariance", rows(scan.covariance)}});
  }
  for (const NetworkCycle& cycle : network.cycles) {
    cycles.push_back(cycle_summary(cycle));
  }
  for (const NetworkContradiction& pair : network.contradictions) {
    contradictions.push_back(contradiction_summary(pair));
  }
  for (const NetworkLink& link : network.links) {
    Json entry = link_summary(link);
    entry.update({{"target_from_source", to_json(link.target_from_source)},
                  {"centre", row(link.precision.centre)},
                  {"covariance", rows(link.precision.covariance)}});
    links.push_back(std::move(entry));
  }
  return {{"igsp", version},
          {"bundle_error", network.bundle_error},
          {"voxel_size", network.voxel_size},
          {"components", network.components},
          {"warnings", network.warnings},
          {"scans", scans},
          {"links", links},
          {"cycles", cycles},
          {"contradictions", contradictions},
          {"min_unconfirmed_confidence", options.min_unconfirmed_confidence},
          {"min_unconfirmed_matches", options.min_unconfirmed_matches},
          {"options", to_json(options.pair)}};
}

std::string network_summary(const Network& network) {
  std::size_t placed = 0;
  std::string alone, separator;
  std::size_t number_alone = 0;
  for (const std::vector<std::size_t>& component : network.components) {
    if (component.size() > 1) {
      placed += component.size();
      continue;
    }
    ++number_alone;
    const NetworkScan& scan = network.scans[component.front()];
    alone += fmt::format("{}{}: {}", separator, short_name(scan.name),
                         scan.problem.empty() ? "no overlap found" : scan.problem);
    separator = "; ";
  }
  std::string text = fmt::format("registered {} of {} scans", placed, network.scans.size());
  if (placed > 0) text += ": " + groups(network);
  if (number_alone > 0) text += fmt::format("; {} alone ({})", number_alone, alone);
  const std::size_t unconfirmed = count(network, LinkState::unconfirmed),
                    rejected = count(network, LinkState::rejected);
  text += fmt::format("\n{} of {} pairs registered, {} rejected by the network, {} {} unconfirmed (in no loop)",
                      std::ranges::count_if(network.links, is_registered_pair), pairs_tried(network), rejected,
                      unconfirmed, unconfirmed == 1 ? "link is" : "links are");
  if (placed > 0) text += fmt::format("; bundle error {:.3g}", network.bundle_error);
  return text + "\n";
}

}  // namespace igsp::cli
