#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace igsp::simulation {

/// Random numbers that are the same with every compiler and standard library (those of std::normal_distribution are
/// not): the SplitMix64 sequence. Arguments of a function are evaluated in an unspecified order, so never draw twice
/// in one argument list; draw in braces or into named values.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : state_(mix(seed) ^ mix(~stream)) {}

  std::uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15u); }

  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  ///< [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  int integer(int low, int high) { return low + static_cast<int>(uniform() * (high - low + 1)); }  ///< [low, high]
  bool chance(double probability) { return uniform() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

  /// Standard normal (Box-Muller); 1 - u is in (0, 1], where the logarithm is finite.
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  Eigen::Vector3d normal_vector() { return Eigen::Vector3d{normal(), normal(), normal()}; }
  double angle() { return uniform(-std::numbers::pi, std::numbers::pi); }

  Eigen::Vector3d direction() {
    const double z = uniform(-1.0, 1.0), azimuth = angle(), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(azimuth), r * std::sin(azimuth), z};
  }

  /// Uniform over all rotations: a normalised 4D Gaussian is uniform on the unit quaternions.
  Eigen::Matrix3d rotation() {
    const double w = normal(), x = normal(), y = normal(), z = normal();
    return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace igsp::simulation
