#include "registration/range_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/multiversion.hpp"
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

// Four points at a time; generic vectors, which the compiler lowers to what the machine has. Which point goes to which
// lane, and so every rounding, is the same everywhere.
constexpr int lanes = 4;
using Floats = float __attribute__((vector_size(4 * lanes)));
using Doubles = double __attribute__((vector_size(8 * lanes)));
using Bits = std::int64_t __attribute__((vector_size(8 * lanes)));

// What was seen within an aperture about a direction: sums over the lanes.
struct Window {
  Bits seen{};
  Doubles nearest = Doubles{} + std::numeric_limits<double>::infinity();
  std::array<Doubles, 3> sum{}, squares{}, products{};
};

template <typename Vector>
auto total(const Vector& v) {
  return v[0] + v[1] + (v[2] + v[3]);
}
double least(const Doubles& v) {
  return std::min(std::min(v[0], v[1]), std::min(v[2], v[3]));
}

struct Seen {
  int points = 0;
  double nearest = 0;
  Eigen::Vector3d mean, squares, products;  // of the offsets from the direction, of yz, zx and xy

  explicit Seen(const Window& window) : points(static_cast<int>(total(window.seen))), nearest(least(window.nearest)) {
    for (int axis = 0; axis < 3; ++axis) {
      mean[axis] = total(window.sum[axis]) / points;
      squares[axis] = total(window.squares[axis]) / points;
      products[axis] = total(window.products[axis]) / points;
    }
  }

  // Of the two variances across the line of sight, from their sum and their product: the third one is next to nothing.
  bool is_a_line() const {
    const Eigen::Vector3d variance = squares - mean.cwiseAbs2();
    const Eigen::Vector3d covariance =
        products - Eigen::Vector3d(mean.y() * mean.z(), mean.z() * mean.x(), mean.x() * mean.y());
    const double product = variance.y() * variance.z() + variance.z() * variance.x() + variance.x() * variance.y() -
                           covariance.squaredNorm();
    const double sum = variance.sum();
    return product < line / ((1 + line) * (1 + line)) * sum * sum;
  }
};

template <typename Vector, typename Value>
inline __attribute__((always_inline)) void load(Vector& vector, const Value* values, int count) {
  if (count == lanes) {
    std::memcpy(&vector, values, sizeof vector);
  } else {
    vector = Vector{};
    for (int i = 0; i < count; ++i) vector[i] = values[i];
  }
}

inline __attribute__((always_inline)) void keep(Doubles& value, const Bits& mask) {
  value = reinterpret_cast<Doubles>(reinterpret_cast<Bits>(value) & mask);
}

// A run of the grid's points: those within the aperture join the window.
IGSP_MULTIVERSION void look_at_run(const float* x, const float* y, const float* z, const double* ranges, int size,
                                   const std::array<float, 3>& direction, float squared_aperture, Window& window) {
  const Bits numbers{0, 1, 2, 3};
  for (int first = 0; first < size; first += lanes) {
    const int count = std::min(lanes, size - first);
    Floats dx, dy, dz;
    Doubles range;
    load(dx, x + first, count), load(dy, y + first, count), load(dz, z + first, count);
    load(range, ranges + first, count);
    dx -= direction[0], dy -= direction[1], dz -= direction[2];
    const Floats squared = dx * dx + dy * dy + dz * dz;
    const Bits inside = __builtin_convertvector(squared <= squared_aperture, Bits) & (numbers < count);
    Doubles px = __builtin_convertvector(dx, Doubles), py = __builtin_convertvector(dy, Doubles),
            pz = __builtin_convertvector(dz, Doubles);
    keep(px, inside), keep(py, inside), keep(pz, inside);
    window.seen -= inside;  // -1 each
    const Bits nearer = inside & (range < window.nearest);
    keep(range, nearer), keep(window.nearest, ~nearer);
    window.nearest = reinterpret_cast<Doubles>(reinterpret_cast<Bits>(range) | reinterpret_cast<Bits>(window.nearest));
    window.sum[0] += px, window.sum[1] += py, window.sum[2] += pz;
    window.squares[0] += px * px, window.squares[1] += py * py, window.squares[2] += pz * pz;
    window.products[0] += py * pz, window.products[1] += pz * px, window.products[2] += px * py;
  }
}

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
    const float reach = static_cast<float>(growth * aperture_);
    Window window;
    projected_.visit_runs(direction, reach, [&](std::uint32_t begin, std::uint32_t end) {
      look_at_run(&projected_.x[begin], &projected_.y[begin], &projected_.z[begin], &ranges_[begin],
                  static_cast<int>(end - begin), {direction.x(), direction.y(), direction.z()}, reach * reach, window);
    });
    const Seen seen(window);
    if (seen.points < min_seen || seen.is_a_line()) continue;
    if (seen.mean.norm() > max_offset * growth * aperture_) break;
    return {range < seen.nearest - growth * tolerance_ ? Sight::empty : Sight::possible, growth};
  }
  return {Sight::out_of_view, 1};
}

}  // namespace igsp
