#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/percent.hpp"
#include "spatial/hidden_points.hpp"

namespace igsp {
namespace {

// Measured in docs/decisions/0009-where-the-scanner-stood.md.
constexpr double most_hidden = 0.06;           // of the points, from where a scanner stood
constexpr double most_of_neighbours = 0.45;    // of what is hidden from places about it
constexpr double neighbour_distance = 0.04;    // of the cloud's size
constexpr double least_range_ratio = 4.0;      // of the ranges, 95 % to 5 %: a scanner among what it sees
constexpr double least_compared = 1000;        // points
constexpr std::array resolutions = {180, 90};  // cells to a right angle, the finest that has enough points

ViewpointFinding unknown(const std::string& why) {
  return {{}, "unknown: the file does not say, and " + why, ""};
}

double ratio_of_ranges(PointView points) {
  std::vector<double> squares;
  squares.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    squares.push_back(point.squaredNorm());
  }
  const auto rank = static_cast<std::ptrdiff_t>(squares.size() / 20);
  std::ranges::nth_element(squares, squares.begin() + rank);
  const double near = squares[rank];
  std::ranges::nth_element(squares, squares.end() - rank - 1);
  return std::sqrt(squares[squares.size() - rank - 1] / near);
}

double hidden_from_about(const TrimmedCloud& cloud, int resolution) {
  std::array<double, 6> shares{};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double distance = neighbour_distance * cloud.bounds().diagonal();
    const Eigen::Vector3d place =
        Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i / 2)) * (i % 2 ? -distance : distance);
    shares[i] = hidden_points(cloud, place, resolution).share;
  }
  std::ranges::sort(shares);
  return (shares[2] + shares[3]) / 2;
}

}  // namespace

ViewpointFinding viewpoint_at_origin(PointView points) {
  const TrimmedCloud all(points, "cloud");
  if ((all.bounds().min.array() >= 0).any() || (all.bounds().max.array() <= 0).any()) {
    return unknown("its origin lies outside of the cloud");
  }
  // Scanners put there what they did not see, and from beside it that would hide little.
  const auto is_return = [](const Eigen::Vector3d& point) { return !point.isZero(0); };
  Points returned;
  if (!std::ranges::all_of(all.points(), is_return)) {
    std::ranges::copy_if(all.points(), std::back_inserter(returned), is_return);
  }
  const TrimmedCloud cloud = returned.empty() ? all : TrimmedCloud(returned, "cloud");
  if (!(ratio_of_ranges(cloud.points()) > least_range_ratio)) {
    return unknown("the points are about equally far from its origin");
  }
  for (const int resolution : resolutions) {
    const HiddenPoints hidden = hidden_points(cloud, Eigen::Vector3d::Zero(), resolution);
    if (hidden.compared * static_cast<double>(cloud.points().size()) < least_compared) continue;
    if (hidden.share > most_hidden) {
      return unknown(percent(hidden.share) + " of the points are hidden from its origin behind others");
    }
    const double about = hidden_from_about(cloud, resolution);
    const std::string shares =
        fmt::format("from its origin {} of the points are hidden behind others, from places about it {}",
                    percent(hidden.share), percent(about));
    if (hidden.share > most_of_neighbours * about) return unknown(shares);
    return {Eigen::Vector3d::Zero(), "believed, though the file does not say it: " + shares, ""};
  }
  return unknown("its points are too few to tell");
}

}  // namespace igsp
