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

constexpr std::size_t points_of_a_page = 60'000;  // 12 bytes each: the page of a usual survey stays below 2 MB
constexpr std::size_t least_points = 300, most_points = 4000;

// Most pairs of a large survey do not overlap; the page shows the more likely ones of them, links.csv all.
constexpr std::size_t most_refused = 500;

std::string bytes_of(const std::vector<float>& numbers) {
  std::vector<std::uint8_t> bytes;
  for (const float number : numbers) {
    const auto word = std::bit_cast<std::uint32_t>(number);
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
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
          {"points_drawn", bytes_of(drawn.points)}};
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
  for (const NetworkLink* link : links_shown(network)) links.push_back(link_summary(*link));
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
          {"components", network.components},
          {"scans", scans},
          {"links", links},
          {"counts", counts},
          {"pairs_tried", network.links.size()},
          {"options", to_json(options.pair)}};
}

}  // namespace

DrawnScan drawn_scan(const Features& features, std::size_t scans) {
  DrawnScan drawn;
  drawn.origin = features.origin;
  drawn.station_known = features.viewpoint.has_value();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  const std::size_t size = features.points.size();
  for (const Eigen::Vector3d& point : features.points) centre += point / static_cast<double>(size);
  drawn.station = features.origin + features.viewpoint.value_or(centre);
  const std::size_t wanted = std::clamp(points_of_a_page / std::max<std::size_t>(1, scans), least_points, most_points);
  const std::size_t stride = std::max<std::size_t>(1, size / wanted);
  for (std::size_t i = 0; i < size; i += stride) {
    for (const double number : features.points[i]) drawn.points.push_back(static_cast<float>(number));
  }
  return drawn;
}

std::string network_page(const Network& network, const NetworkOptions& options, std::span<const DrawnScan> drawn) {
  return std::string(network_page_head) + inside_script(data_of(network, options, drawn)) +
         std::string(network_page_tail);
}

}  // namespace igsp::cli
