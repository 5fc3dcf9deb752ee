#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "igsp/point_cloud.hpp"

/// What the unit tests of the layers share: random clouds and motions that are the same on every machine.
namespace igsp::testing {

/// Own arithmetic from raw random bits, since the distributions of the standard library differ between implementations.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  int integer(int low, int high) {  ///< [low, high]
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0, 1)));
    return radius * std::cos(2.0 * std::numbers::pi * uniform(0, 1));
  }
  Eigen::Vector3d in_cube(double half_side) {
    const double x = uniform(-half_side, half_side), y = uniform(-half_side, half_side);
    return {x, y, uniform(-half_side, half_side)};
  }
  Eigen::Vector3d direction() {
    const double x = normal(), y = normal(), z = normal();
    return Eigen::Vector3d(x, y, z).normalized();
  }
  Eigen::Matrix3d rotation() {
    const double w = normal(), x = normal(), y = normal(), z = normal();
    return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  }
  Transformation motion(double length) {
    Transformation result = Transformation::Identity();
    result.linear() = rotation();
    result.translation() = in_cube(length);
    return result;
  }

 private:
  std::mt19937_64 engine_;
};

inline Points random_points(Random& random, std::size_t size, double half_side) {
  Points points(size);
  for (Eigen::Vector3d& point : points) point = random.in_cube(half_side);
  return points;
}

/// Height field of a few waves: a surface with curvature of every kind and no symmetry. Waves of length 2 and more.
class BumpySurface {
 public:
  explicit BumpySurface(Random& random, double height = 0.6) {
    for (Wave& wave : waves_) {
      const double azimuth = random.uniform(0, 2 * std::numbers::pi), length = random.uniform(2, 6);
      wave.x = 2 * std::numbers::pi / length * std::cos(azimuth);
      wave.y = 2 * std::numbers::pi / length * std::sin(azimuth);
      wave.phase = random.uniform(0, 2 * std::numbers::pi);
      wave.height = height * length / 6;
    }
  }
  double height_at(double x, double y) const {
    double z = 0;
    for (const Wave& wave : waves_) z += wave.height * std::sin(wave.x * x + wave.y * y + wave.phase);
    return z;
  }
  /// Evenly random over the square |x|, |y| < half_side.
  Points sample(Random& random, std::size_t size, double half_side) const {
    Points points(size);
    for (Eigen::Vector3d& point : points) {
      const double x = random.uniform(-half_side, half_side), y = random.uniform(-half_side, half_side);
      point = {x, y, height_at(x, y)};
    }
    return points;
  }

 private:
  struct Wave {
    double x, y, phase, height;
  };
  Wave waves_[6];
};

inline Points moved(const Transformation& motion, PointView points) {
  Points result;
  result.reserve(points.size());
  for (const Eigen::Vector3d& point : points) result.push_back(motion * point);
  return result;
}

}  // namespace igsp::testing
