#include "igsp/viewpoint.hpp"

#include <fmt/format.h>

#include "core/percent.hpp"
#include "spatial/hidden_points.hpp"

namespace igsp {
namespace {

constexpr double most = 0.5;  // hidden from a viewpoint, of the points: it contradicts the cloud

ViewpointFinding given(PointView points, const ViewpointRequest& request) {
  const double hidden = hidden_points(points, request.position).share;
  if (hidden <= most) return {request.position, "given", ""};
  if (request.insist) {
    return {request.position, "given and insisted on, though " + percent(hidden) + " of the points are hidden from it",
            ""};
  }
  const std::string why = percent(hidden) + " of the points are hidden from it behind others";
  return {{}, "unknown: what was given contradicts the cloud, " + why, why};
}

ViewpointFinding declared_by_file(PointView points, const Eigen::Vector3d& declared) {
  const double hidden = declared.allFinite() ? hidden_points(points, declared).share : 1;
  if (hidden <= most) return {declared, "the file says so", ""};
  return {{},
          "unknown: what the file says contradicts its points, of which " + percent(hidden) + " are hidden from it",
          ""};
}

}  // namespace

ViewpointFinding find_viewpoint(PointView points, const ViewpointRequest& request,
                                const std::optional<Eigen::Vector3d>& declared) {
  switch (request.kind) {
    case ViewpointRequest::Kind::given:
      return given(points, request);
    case ViewpointRequest::Kind::none:
      return {{}, "none, as asked", ""};
    case ViewpointRequest::Kind::automatic:
      break;
  }
  if (declared) return declared_by_file(points, *declared);
  return viewpoint_at_origin(points);
}

ViewpointFinding find_viewpoints(PointView points, const ViewpointRequest& request,
                                 const std::vector<ScanPart>& declared) {
  if (request.kind != ViewpointRequest::Kind::automatic) return find_viewpoint(points, request);
  ViewpointFinding all{.viewpoint = {}, .reason = "", .warning = "", .parts = declared};
  std::size_t begin = 0, known = 0;
  std::string unknown;  // why, of the first that is
  for (std::size_t i = 0; i < declared.size(); ++i) {
    const PointView seen = points.subspan(begin, declared[i].points);
    begin += seen.size();
    const ViewpointFinding found = seen.empty() ? ViewpointFinding{{}, "unknown: it has no points", ""}
                                                : find_viewpoint(seen, request, declared[i].viewpoint);
    all.parts[i].viewpoint = found.viewpoint;
    if (found.viewpoint) {
      ++known;
    } else if (unknown.empty()) {
      unknown = fmt::format(", that of scan {} is {}", i, found.reason);
    }
  }
  all.reason = fmt::format("{} scans in one file, {} of their viewpoints known{}", declared.size(),
                           known == declared.size() ? "all" : std::to_string(known), unknown);
  return all;
}

}  // namespace igsp
