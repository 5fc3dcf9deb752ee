#pragma once

#include <cmath>
#include <random>
#include <string>

#include "igsp/igsp.hpp"

/// What the end-to-end tests share: scenes, seeded motions, and how far two answers lie apart.
namespace igsp::testing {

struct Pair {
  Points source;
  Points target;
  Transformation truth = Transformation::Identity();  ///< target_from_source
};

inline Pair simulated_pair(std::string_view scene, int points, double station_distance = 0.0, std::uint64_t seed = 7) {
  SimulationOptions options;
  options.points = points;
  options.station_distance = station_distance;
  options.seed = seed;
  std::vector<SimulatedScan> scans = simulate(scene, options);
  const Transformation truth = scans[1].world_from_scanner.inverse() * scans[0].world_from_scanner;
  return {std::move(scans[0].points), std::move(scans[1].points), truth};
}

/// A uniform rotation and a translation of the given length. Own arithmetic from raw random bits, since the
/// distributions of the standard library differ between implementations.
inline Transformation random_motion(std::uint64_t seed, double length) {
  std::mt19937_64 bits(seed);
  const auto uniform = [&] { return 2.0 * (static_cast<double>(bits() >> 11) * 0x1p-53) - 1.0; };
  const auto in_ball = [&](auto vector) {
    do {
      for (auto& entry : vector) entry = uniform();
    } while (vector.squaredNorm() > 1.0 || vector.squaredNorm() < 0.01);
    return vector;
  };
  const Eigen::Vector4d q = in_ball(Eigen::Vector4d()).normalized();
  Transformation motion(Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
  motion.translation() = length * in_ball(Eigen::Vector3d()).normalized();
  return motion;
}

inline Points moved(const Transformation& motion, PointView points) {
  Points result;
  result.reserve(points.size());
  for (const Eigen::Vector3d& point : points) result.push_back(motion * point);
  return result;
}

inline Eigen::Vector3d centroid(PointView points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

/// Root mean square distance of the points from their centroid: the lever arm that turns an angle into a length.
inline double radius_of_gyration(PointView points) {
  const Eigen::Vector3d mean = centroid(points);
  double sum = 0.0;
  for (const Eigen::Vector3d& point : points) sum += (point - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

/// The same pair with its source moved away, so that no start pose helps.
inline Pair scrambled(Pair pair, std::uint64_t seed) {
  const Transformation away = random_motion(seed, 3.0 * radius_of_gyration(pair.source));
  return {moved(away, pair.source), std::move(pair.target), pair.truth * away.inverse()};
}

/// How far apart two answers put the cloud: displacement of its centroid plus rotation times its lever arm, in the
/// unit of the cloud. Independent of the origin, and of whether an error hides in the rotation or the translation.
inline double disagreement(const Transformation& a, const Transformation& b, PointView points) {
  const PoseError error = pose_error(a, b, centroid(points));
  return error.centroid_displacement + error.rotation_rad * radius_of_gyration(points);
}

}  // namespace igsp::testing
