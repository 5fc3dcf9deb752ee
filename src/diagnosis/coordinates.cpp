#include "diagnosis/coordinates.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/parallel.hpp"

namespace igsp {
namespace {

constexpr std::size_t few_points = 3000;   // of simulated rooms and parks thinned further most pairs are refused
constexpr double flat_thickness = 1e-6;    // of the largest deviation: rounding after a rotation, no surface
constexpr double degrees_flatness = 20.0;  // a metre is a hundred thousandth of a degree
constexpr double far_from_zero = 10.0;     // extents
constexpr double coarse_step = 0.25;       // voxels
constexpr std::size_t sampled_points = 20000;
constexpr std::size_t glanced_points = 500;  // show of most clouds already that they are neither flat nor coarse
constexpr double far_from_flat = 100.0;      // times the thickness of what is
constexpr std::size_t least_values = 8;      // fewer may lie in equal steps by chance, as the sides of a box do
constexpr double step_tolerance = 0.01;      // of a step: decimal steps are not exact in binary

constexpr std::array<std::string_view, 3> axis_names{"x", "y", "z"};

/// "the source", "the target", "both clouds" from one finding a cloud; empty if there is none.
std::string who(bool source, bool target) {
  if (source && target) return "both clouds";
  if (source) return "the source";
  return target ? "the target" : "";
}

/// Square roots of the eigenvalues of the covariance, ascending.
Eigen::Vector3d deviations(PointView cloud, const Bounds& bounds) {
  const Eigen::Vector3d origin = centre_of(bounds);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : cloud) sum += point - origin;
  const Eigen::Vector3d mean = sum / static_cast<double>(cloud.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : cloud) {
    const Eigen::Vector3d d = point - origin - mean;
    covariance += d * d.transpose() / static_cast<double>(cloud.size());
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .cwiseMax(0.0)
      .cwiseSqrt();
}

/// The axis whose coordinate is one value everywhere; -1 if none is.
int constant_axis(const Bounds& bounds) {
  for (int axis = 2; axis >= 0; --axis) {
    if (bounds.min[axis] == bounds.max[axis]) return axis;
  }
  return -1;
}

bool looks_like_degrees(const Bounds& bounds) {
  const Eigen::Vector3d extent = bounds.max - bounds.min;
  const Eigen::Vector3d magnitude = bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs());
  const double across = std::max(extent.x(), extent.y());
  const bool on_earth = magnitude.x() <= 180 && magnitude.y() <= 180 && std::min(magnitude.x(), magnitude.y()) <= 90;
  return on_earth && across > 0 && across < 1 && extent.z() > degrees_flatness * across &&
         std::max(magnitude.x(), magnitude.y()) > far_from_zero * across;
}

/// About `most` of the points, evenly.
Points some_of(PointView cloud, std::size_t most) {
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / most);
  Points some;
  for (std::size_t i = 0; i < cloud.size(); i += stride) some.push_back(cloud[i]);
  return some;
}

bool is_thin(const Eigen::Vector3d& deviations, int i, double thickness = flat_thickness) {
  return deviations[i] <= thickness * deviations[2];
}

/// Square roots of the eigenvalues of the covariance, ascending: of all points where some do not show that these do not
/// lie on a plane.
Eigen::Vector3d settled_deviations(PointView cloud, const Bounds& bounds) {
  const Eigen::Vector3d of_some = deviations(some_of(cloud, glanced_points), bounds);
  return is_thin(of_some, 0, far_from_flat * flat_thickness) ? deviations(cloud, bounds) : of_some;
}

/// The step that all of the sorted values are multiples of, from the least of them on; 0 if there is none to be seen.
double step_of(std::vector<double> values) {
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() < least_values) return 0;
  double step = values[1] - values[0];
  for (std::size_t i = 2; i < values.size(); ++i) step = std::min(step, values[i] - values[i - 1]);
  const bool regular = std::all_of(values.begin(), values.end(), [&](double value) {
    const double steps = (value - values.front()) / step;
    return std::abs(steps - std::round(steps)) < step_tolerance;
  });
  return regular ? step : 0;
}

struct Coarseness {
  int axis = 0;
  double step = 0;
  double largest = 0;  // coordinate of that axis, in magnitude
};

/// Of the axes whose steps are larger than `limit`.
Coarseness coarsest_axis(PointView cloud, const Bounds& bounds, double limit) {
  const auto values_of = [](const Points& points, int axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& point : points) values.push_back(point[axis]);
    std::sort(values.begin(), values.end());
    return values;
  };
  const auto is_finer = [&](const std::vector<double>& values) {
    return std::ranges::adjacent_find(values, [&](double a, double b) { return b > a && b - a <= limit; }) !=
           values.end();
  };
  const Points few = some_of(cloud, glanced_points);
  Coarseness coarsest;
  for (int axis = 0; axis < 3; ++axis) {
    if (is_finer(values_of(few, axis))) continue;
    const double step = step_of(values_of(some_of(cloud, sampled_points), axis));
    if (step > std::max(limit, coarsest.step)) {
      coarsest = {axis, step, std::max(std::abs(bounds.min[axis]), std::abs(bounds.max[axis]))};
    }
  }
  return coarsest;
}

/// Spacing of single precision at this magnitude.
double float_step(double magnitude) {
  return std::ldexp(1.0, std::ilogb(magnitude) - 23);
}

}  // namespace

PairCoordinates::PairCoordinates(PointView source, PointView target, int threads) : threads_(threads) {
  parallel_pair(
      threads,
      [&] {
        source_ = {source, bounds_of(source, "source")};
      },
      [&] {
        target_ = {target, bounds_of(target, "target")};
      });
}

template <typename Question>
auto PairCoordinates::of_both(const Question& question) const {
  std::pair<decltype(question(source_)), decltype(question(target_))> answers;
  parallel_pair(
      threads_, [&] { answers.first = question(source_); }, [&] { answers.second = question(target_); });
  return answers;
}

std::optional<Diagnosis> PairCoordinates::too_few() const {
  const std::size_t in_source = source_.points.size(), in_target = target_.points.size();
  const std::string name = who(in_source < few_points, in_target < few_points);
  if (name.empty()) return std::nullopt;
  return Diagnosis{Cause::too_few_points,
                   fmt::format("few points in {}: {} in the source, {} in the target; below some {} a scene is seldom "
                               "described well enough: take denser scans, or all of their points",
                               name, in_source, in_target, few_points),
                   {}};
}

std::optional<Diagnosis> PairCoordinates::flat() const {
  const auto [of_source, of_target] =
      of_both([](const Cloud& cloud) { return settled_deviations(cloud.points, cloud.bounds); });
  const std::string name = who(is_thin(of_source, 0), is_thin(of_target, 0));
  if (name.empty()) return std::nullopt;
  const Bounds& bounds = is_thin(of_source, 0) ? source_.bounds : target_.bounds;
  const bool line = is_thin(of_source, 1) || is_thin(of_target, 1);
  const int axis = constant_axis(bounds);  // -0 is 0, hence the sum below
  const std::string seen =
      line        ? fmt::format("all points of {} lie on a line", name)
      : axis >= 0 ? fmt::format("{} is {} everywhere in {}", axis_names[axis], bounds.min[axis] + 0.0, name)
                  : fmt::format("all points of {} lie on one plane", name);
  return Diagnosis{Cause::flat,
                   seen +
                       ": surfaces in space are what is registered, and in two dimensions there are none; give all "
                       "three coordinates, or register outlines with a program for 2-D scans",
                   {}};
}

std::optional<Diagnosis> PairCoordinates::degrees() const {
  const std::string name = who(looks_like_degrees(source_.bounds), looks_like_degrees(target_.bounds));
  if (name.empty()) return std::nullopt;
  return Diagnosis{Cause::degrees,
                   fmt::format("x and y of {} look like longitude and latitude in degrees beside heights in metres: "
                               "project them first, so that all three coordinates have one unit of length",
                               name),
                   {}};
}

std::optional<Diagnosis> PairCoordinates::coarse(double voxel_size) const {
  const double limit = coarse_step * voxel_size;
  const auto [of_source, of_target] =
      of_both([limit](const Cloud& cloud) { return coarsest_axis(cloud.points, cloud.bounds, limit); });
  const std::string name = who(of_source.step > 0, of_target.step > 0);
  if (name.empty()) return std::nullopt;
  const Coarseness& worst = of_source.step >= of_target.step ? of_source : of_target;
  const bool as_float = worst.step <= float_step(worst.largest);
  const std::string remedy =
      as_float
          ? fmt::format("as floats have them at {:.0f}: subtract an offset before they are stored, or store doubles",
                        worst.largest)
          : "so that surfaces turn into stairs: export it with more digits";
  return Diagnosis{Cause::coarse_coordinates,
                   fmt::format("{} of {} comes in steps of {:.3g} where a voxel has {:.3g}, {}", axis_names[worst.axis],
                               name, worst.step, voxel_size, remedy),
                   {}};
}

}  // namespace igsp
