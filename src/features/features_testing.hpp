#pragma once

#include <bit>

#include "core/core_testing.hpp"
#include "features/bsc_layout.hpp"
#include "features/support.hpp"
#include "igsp/features.hpp"

/// What the tests of frames and descriptors share.
namespace igsp::testing {

inline Support support_of(PointView points) {
  Support support;
  for (const Eigen::Vector3d& point : points) {
    support.x.push_back(static_cast<float>(point.x()));
    support.y.push_back(static_cast<float>(point.y()));
    support.z.push_back(static_cast<float>(point.z()));
  }
  return support;
}

/// Points within sqrt(3) R, filling a random box, so that the principal axes are apart.
inline Points random_support(Random& random, std::size_t size, double radius) {
  const double a = random.uniform(0.2, 1), b = random.uniform(0.2, 1), c = random.uniform(0.2, 1);
  const Eigen::Vector3d scale = std::sqrt(3.0) * radius * Eigen::Vector3d(a, b, c);
  const Eigen::Matrix3d rotation = random.rotation();
  Points points;
  while (points.size() < size) {
    const Eigen::Vector3d point = rotation * scale.cwiseProduct(random.in_cube(1));
    if (point.norm() < std::sqrt(3.0) * radius) points.push_back(point);
  }
  return points;
}

/// A dense bumpy surface patch about the origin, cut off at sqrt(3) R.
inline Points surface_support(Random& random, std::size_t size, double radius) {
  const BumpySurface shape(random);
  const Eigen::Vector3d centre(0, 0, shape.height_at(0, 0));
  Points points;
  for (Eigen::Vector3d point : shape.sample(random, size, std::sqrt(3.0) * radius)) {
    point -= centre;
    if (point.norm() < std::sqrt(3.0) * radius) points.push_back(point);
  }
  return points;
}

inline Eigen::Matrix3d with_signs(const Eigen::Matrix3d& frame, int frame_flip) {
  const auto& signs = bsc::frame_flips[frame_flip].signs;
  return frame * Eigen::Vector3d(signs[0], signs[1], signs[2]).asDiagonal();
}

inline bool bit_of(const Descriptor& descriptor, int bit) {
  return descriptor[bit / 64] >> (bit % 64) & 1;
}

inline int differing_bits(const Descriptor& a, const Descriptor& b) {
  int count = 0;
  for (int word = 0; word < bsc_words; ++word) count += std::popcount(a[word] ^ b[word]);
  return count;
}

inline Descriptor random_descriptor(Random& random) {
  Descriptor descriptor{};
  for (int bit = 0; bit < bsc_bits; ++bit) {
    descriptor[bit / 64] |= static_cast<std::uint64_t>(random.integer(0, 1)) << (bit % 64);
  }
  return descriptor;
}

}  // namespace igsp::testing
