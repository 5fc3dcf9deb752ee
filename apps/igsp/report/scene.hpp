#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "igsp/point_cloud.hpp"
#include "report/json.hpp"

namespace igsp::cli {

/// What the page draws, in the form that its scripts read: both clouds thinned, their coordinates in 16 bits relative
/// to an origin of their own; and every pose of the run, each with the distance of every drawn source point to the
/// nearest of all target points. `run` is what align_report gives. Throws Cancelled after an interrupt.
Json report_scene(const Json& run, const Scan& source, const Scan& target);

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace igsp::cli
