#include "registration/range_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spatial/direction_image.hpp"

namespace igsp {
namespace {

// About 1 degree for a scan of a room or a street. Smaller, a direction falls between two points; larger, more stands
// in the aperture that is near by, and less is found empty.
constexpr double aperture = 1.5;    // voxels, at the median range
constexpr double in_front = 4.0;    // voxels: beyond noise, and beyond what two scans see of one grazing surface
constexpr double most_growth = 8;   // of the aperture, where a scanner's lines lie far apart
constexpr double line = 0.05;       // one variance of the other
constexpr int min_seen = 3;         // points in the aperture
constexpr double max_offset = 0.5;  // of their mean from the direction, in apertures: a half disc has 0.42, a rim more

// What was seen within an aperture about a direction. In which order Eigen sums up three floats depends on the
// processor, that of doubles does not.
struct Window {
  int seen = 0;
  double nearest = std::numeric_limits<double>::infinity();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero(), products = Eigen::Vector3d::Zero();

  void add(const Eigen::Vector3d& offset, double range) {
    ++seen;
    nearest = std::min(nearest, range);
    sum += offset;
    squares += offset.cwiseAbs2();
    products += Eigen::Vector3d(offset.y() * offset.z(), offset.z() * offset.x(), offset.x() * offset.y());
  }

  double offset() const { return sum.norm() / seen; }

  // Of the two variances across the line of sight, from their sum and their product: the third one is next to nothing.
  bool is_a_line() const {
    const Eigen::Vector3d mean = sum / seen, variance = squares / seen - mean.cwiseAbs2();
    const Eigen::Vector3d covariance =
        products / seen - Eigen::Vector3d(mean.y() * mean.z(), mean.z() * mean.x(), mean.x() * mean.y());
    const double product = variance.y() * variance.z() + variance.z() * variance.x() + variance.x() * variance.y() -
                           covariance.squaredNorm();
    const double total = variance.sum();
    return product < line / ((1 + line) * (1 + line)) * total * total;
  }
};

double largest_distance(PointView points, const Eigen::Vector3d& from) {
  double squared = 0;
  for (const Eigen::Vector3d& point : points) squared = std::max(squared, (point - from).squaredNorm());
  return std::sqrt(squared);
}

// A cloud has the size of a voxel at least: squares of what is far smaller are 0.
Eigen::Vector3d drawn_near(PointView points, const Eigen::Vector3d& viewpoint, double voxel_size) {
  const double size = std::max(largest_distance(points, Eigen::Vector3d::Zero()), voxel_size);
  return not_too_far(viewpoint, Eigen::Vector3d::Zero(), size);
}

double median_range(PointView points, const Eigen::Vector3d& viewpoint) {
  if (points.empty()) return 0;
  std::vector<double> ranges;
  ranges.reserve(points.size());
  for (const Eigen::Vector3d& point : points) ranges.push_back((point - viewpoint).norm());
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return *middle;
}

}  // namespace

RangeImage::RangeImage(PointView points, const Eigen::Vector3d& viewpoint, double voxel_size)
    : viewpoint_(drawn_near(points, viewpoint, voxel_size)),
      aperture_(aperture * voxel_size),
      tolerance_(in_front * voxel_size),
      radius_(median_range(points, viewpoint_)),
      projected_(project(points), aperture_) {
  ranges_.reserve(points.size());
  for (const std::uint32_t i : projected_.index) ranges_.push_back((points[i] - viewpoint_).norm());
}

Points RangeImage::project(PointView points) const {
  Points projected;
  projected.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d ray = point - viewpoint_;
    const double range = ray.norm();
    projected.push_back(range > 0 ? on_sphere(ray, range) : viewpoint_);
  }
  return projected;
}

RangeImage::Look RangeImage::look_at(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d ray = point - viewpoint_;
  const double range = ray.norm();
  if (!(range > 0)) return {Sight::out_of_view, 1};
  const Eigen::Vector3f direction = on_sphere(ray, range).cast<float>();
  for (double growth = 1; growth <= most_growth; growth *= 2) {
    Window window;
    projected_.visit_sphere(direction, static_cast<float>(growth * aperture_), [&](std::uint32_t i, float) {
      const Eigen::Vector3f offset = Eigen::Vector3f(projected_.x[i], projected_.y[i], projected_.z[i]) - direction;
      window.add(offset.cast<double>(), ranges_[i]);
    });
    if (window.seen < min_seen || window.is_a_line()) continue;
    if (window.offset() > max_offset * growth * aperture_) break;
    return {range < window.nearest - growth * tolerance_ ? Sight::empty : Sight::possible, growth};
  }
  return {Sight::out_of_view, 1};
}

}  // namespace igsp
