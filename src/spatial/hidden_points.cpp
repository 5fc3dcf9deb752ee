#include "spatial/hidden_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "igsp/errors.hpp"
#include "spatial/direction_image.hpp"

namespace igsp {
namespace {

constexpr double tolerance = 1.0 / 50;  // of the cloud's size: what one surface at a grazing angle spans in a direction

}  // namespace

HiddenPoints hidden_points(PointView points, const Eigen::Vector3d& viewpoint, int to_a_right_angle) {
  const TrimmedCloud cloud(points, "cloud");
  if (!viewpoint.allFinite()) throw InvalidArgument("viewpoint is not finite; three finite coordinates are needed");
  if (to_a_right_angle < 1 || to_a_right_angle > 1000) {
    throw InvalidArgument(fmt::format("to_a_right_angle = {} is not in [1, 1000]", to_a_right_angle));
  }
  return hidden_points(cloud, viewpoint, to_a_right_angle);
}

HiddenPoints hidden_points(const TrimmedCloud& cloud, const Eigen::Vector3d& position, int to_a_right_angle) {
  const PointView points = cloud.points();
  const double size = cloud.bounds().diagonal();
  if (size == 0) return {};
  const Eigen::Vector3d centre = centre_of(cloud.bounds()), viewpoint = not_too_far(position, centre, size);
  const DirectionImage image(viewpoint, centre, 0.5 * size, to_a_right_angle);
  std::vector<double> nearest(image.cells(), std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> seen(image.cells(), 0);
  std::vector<std::uint32_t> cell(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    cell[i] = image.cell_of(points[i]);
    if (cell[i] == DirectionImage::nowhere) continue;
    nearest[cell[i]] = std::min(nearest[cell[i]], (points[i] - viewpoint).norm());
    ++seen[cell[i]];
  }
  std::size_t compared = 0, hidden = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (cell[i] == DirectionImage::nowhere || seen[cell[i]] < 2) continue;
    ++compared;
    hidden += (points[i] - viewpoint).norm() > nearest[cell[i]] + tolerance * size;
  }
  return {compared > 0 ? static_cast<double>(hidden) / static_cast<double>(compared) : 0.0,
          static_cast<double>(compared) / static_cast<double>(points.size())};
}

}  // namespace igsp
