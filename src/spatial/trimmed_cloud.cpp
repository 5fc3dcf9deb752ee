#include "spatial/trimmed_cloud.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace igsp {
namespace {

constexpr std::size_t bins = 64;
constexpr double max_share = 0.02;
constexpr double min_gap = 0.5;         // of the extent that stays
constexpr std::size_t min_points = 50;  // of fewer, no two are a crowd and the rest strays

using Counts = std::array<std::array<std::size_t, bins>, 3>;

bool contains(const Bounds& bounds, const Eigen::Vector3d& point) {
  return (point.array() >= bounds.min.array()).all() && (point.array() <= bounds.max.array()).all();
}

Counts count_along_axes(PointView cloud, const Bounds& bounds) {
  Counts counts{};
  const Eigen::Vector3d extent = bounds.max - bounds.min;
  const Eigen::Vector3d per_length = (extent.array() > 0).select(bins / extent.array().max(1e-300), 0.0);
  for (const Eigen::Vector3d& point : cloud) {
    if (!contains(bounds, point)) continue;
    const Eigen::Vector3d place = (point - bounds.min).cwiseProduct(per_length);
    for (int axis = 0; axis < 3; ++axis) {
      ++counts[axis][std::min<std::size_t>(bins - 1, static_cast<std::size_t>(place[axis]))];
    }
  }
  return counts;
}

// Bins of one axis that hold the crowd: [first, last].
struct BinRange {
  std::size_t first = 0, last = bins - 1;
  bool is_all() const { return first == 0 && last == bins - 1; }
};

// From either end inwards: what lies before an empty stretch goes, if it is little and the stretch long.
BinRange crowd_of(const std::array<std::size_t, bins>& counts, std::size_t max_outside) {
  const auto first_of_crowd = [&](auto count) {
    std::size_t passed = 0, result = 0;
    for (std::size_t i = 0; i < bins && passed <= max_outside; ++i) {
      const std::size_t begin = i;
      while (i < bins && count(i) == 0) ++i;
      if (i == bins) break;
      const bool is_gap = static_cast<double>(i - begin) >= min_gap * static_cast<double>(bins - i);
      if (is_gap && passed > 0) result = i;
      passed += count(i);
    }
    return result;
  };
  const std::size_t first = first_of_crowd([&](std::size_t i) { return counts[i]; });
  const std::size_t last = bins - 1 - first_of_crowd([&](std::size_t i) { return counts[bins - 1 - i]; });
  return first <= last ? BinRange{first, last} : BinRange{};
}

Bounds bounds_within(PointView cloud, const Bounds& outer, const std::array<BinRange, 3>& crowd) {
  const Eigen::Vector3d bin = (outer.max - outer.min) / bins;
  Bounds box = outer;
  for (int axis = 0; axis < 3; ++axis) {
    // Half a bin of the empty stretch on either side keeps rounding from cutting the crowd.
    if (crowd[axis].first > 0) box.min[axis] = outer.min[axis] + (crowd[axis].first - 0.5) * bin[axis];
    if (crowd[axis].last < bins - 1) box.max[axis] = outer.min[axis] + (crowd[axis].last + 1.5) * bin[axis];
  }
  Bounds inner{box.max, box.min};
  for (const Eigen::Vector3d& point : cloud) {
    if (!contains(box, point)) continue;
    inner.min = inner.min.cwiseMin(point);
    inner.max = inner.max.cwiseMax(point);
  }
  return inner;
}

StrayPoints stray_points(PointView cloud, const Bounds& bounds) {
  StrayPoints stray;
  double farthest = 0;
  for (const Eigen::Vector3d& point : cloud) {
    if (contains(bounds, point)) continue;
    ++stray.count;
    farthest = std::max(farthest, (point - point.cwiseMax(bounds.min).cwiseMin(bounds.max)).norm());
  }
  stray.extents_away = farthest / bounds.diagonal();
  return stray;
}

}  // namespace

TrimmedCloud::TrimmedCloud(PointView cloud, std::string_view name) : given_(cloud), bounds_(bounds_of(cloud, name)) {
  if (cloud.size() < min_points) return;
  const auto max_outside = static_cast<std::size_t>(max_share * static_cast<double>(cloud.size()));
  while (bounds_.diagonal() > 0) {
    const Counts counts = count_along_axes(cloud, bounds_);
    std::array<BinRange, 3> crowd;
    for (int axis = 0; axis < 3; ++axis) crowd[axis] = crowd_of(counts[axis], max_outside);
    if (std::ranges::all_of(crowd, &BinRange::is_all)) break;
    const Bounds within = bounds_within(cloud, bounds_, crowd);
    const StrayPoints stray = stray_points(cloud, within);
    // Where all that stays is one place, it is no cloud; where much would go, it is no stray.
    if (!(within.diagonal() > 0) || stray.count > max_outside) break;
    bounds_ = within;
    stray_ = stray;
  }
  if (stray_.count == 0) return;
  kept_.reserve(cloud.size() - stray_.count);
  std::ranges::copy_if(cloud, std::back_inserter(kept_), [&](const auto& point) { return contains(bounds_, point); });
}

std::size_t TrimmedCloud::count_kept(PointView given) const {
  if (stray_.count == 0) return given.size();
  return static_cast<std::size_t>(
      std::ranges::count_if(given, [&](const auto& point) { return contains(bounds_, point); }));
}

TrimmedCloud TrimmedCloud::in_unit(double unit) const {
  TrimmedCloud scaled = *this;
  scaled.kept_.assign(points().begin(), points().end());
  for (Eigen::Vector3d& point : scaled.kept_) point /= unit;
  scaled.bounds_.min /= unit;
  scaled.bounds_.max /= unit;
  return scaled;
}

}  // namespace igsp
