#pragma once

#include <span>
#include <string>
#include <string_view>

#include "network/drawn_scan.hpp"
#include "network/outputs.hpp"

namespace igsp::cli {

/// One HTML file that opens offline: map, links, loops, stations, options. `drawn` by scan.
std::string network_page(const Network& network, const NetworkOptions& options, std::span<const DrawnScan> drawn);

// The page before and after its data, assembled from template/ when igsp is built.
extern const std::string_view network_page_head;
extern const std::string_view network_page_tail;

}  // namespace igsp::cli
