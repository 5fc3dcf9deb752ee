#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "igsp/features.hpp"
#include "network/outputs.hpp"

namespace igsp::cli {

/// What the page draws of a scan, in the scan's own frame.
struct DrawnScan {
  Eigen::Vector3d station = Eigen::Vector3d::Zero();  ///< where the scanner stood, else the centre of the scan
  bool station_known = false;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of `points`
  std::vector<float> points;                         ///< x, y, z of some voxel centroids, relative to `origin`
};

/// `scans`: how many share the page.
DrawnScan drawn_scan(const Features& features, std::size_t scans);

/// One HTML file that opens offline: map, links, stations, options. `drawn` by scan.
std::string network_page(const Network& network, const NetworkOptions& options, std::span<const DrawnScan> drawn);

// The page before and after its data, assembled from template/ when igsp is built.
extern const std::string_view network_page_head;
extern const std::string_view network_page_tail;

}  // namespace igsp::cli
