#include "spatial/trimmed_scan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "igsp/errors.hpp"
#include "spatial/unit_of_length.hpp"

namespace igsp {
namespace {

void require_finite(const std::optional<Eigen::Vector3d>& viewpoint) {
  if (!viewpoint || viewpoint->allFinite()) return;
  throw InvalidArgument(fmt::format("viewpoint = {},{},{} is not finite; three finite coordinates are needed",
                                    viewpoint->x(), viewpoint->y(), viewpoint->z()));
}

void require_parts_of(const Scan& scan, std::string_view name) {
  require_finite(scan.viewpoint);
  if (scan.parts.empty()) return;
  if (scan.viewpoint) {
    throw InvalidArgument(fmt::format("{} has parts and a viewpoint; each of its parts has its own", name));
  }
  std::size_t left = scan.points.size();
  bool fits = true;
  for (const ScanPart& part : scan.parts) {
    require_finite(part.viewpoint);
    fits = fits && part.points <= left;
    if (fits) left -= part.points;
  }
  if (fits && left == 0) return;
  throw InvalidArgument(fmt::format("the parts of {} have {} points than it: each of its {} points is of one part",
                                    name, fits ? "fewer" : "more", scan.points.size()));
}

// A single scan is a cloud of one part.
std::vector<ScanPart> parts_of(const Scan& scan, std::string_view name) {
  require_parts_of(scan, name);
  std::vector<ScanPart> parts = scan.parts;
  if (scan.viewpoint) parts = {{scan.points.size(), scan.viewpoint}};
  return parts;
}

}  // namespace

TrimmedScan::TrimmedScan(const Scan& scan, std::string_view name)
    : parts(parts_of(scan, name)), cloud(scan.points, name) {
  std::size_t begin = 0;
  for (ScanPart& part : parts) {
    const PointView given = scan.points.subspan(begin, part.points);
    begin += given.size();
    part.points = cloud.count_kept(given);
  }
  std::erase_if(parts, [](const ScanPart& part) { return part.points == 0; });
  if (std::ranges::none_of(parts, [](const ScanPart& part) { return part.viewpoint.has_value(); })) parts.clear();
}

TrimmedScan TrimmedScan::in_unit(double unit) const {
  TrimmedScan scaled = *this;
  scaled.cloud = cloud.in_unit(unit);
  for (ScanPart& part : scaled.parts) part.viewpoint = igsp::in_unit(part.viewpoint, unit);
  return scaled;
}

}  // namespace igsp
