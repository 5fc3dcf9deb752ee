#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "simulation/primitives.hpp"

namespace igsp::simulation {

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t primitive = 0;  ///< index into BoundingVolumeHierarchy::primitives()

  explicit operator bool() const { return distance < std::numeric_limits<double>::infinity(); }
};

/// First hit of a ray among many primitives: a binary tree of boxes, split where the surface area heuristic expects
/// the least work.
class BoundingVolumeHierarchy {
 public:
  BoundingVolumeHierarchy() = default;
  explicit BoundingVolumeHierarchy(const Primitives& primitives);

  /// The nearest hit below `max_distance`.
  Hit first_hit(const Ray& ray, double max_distance = std::numeric_limits<double>::infinity()) const;

  const Primitives& primitives() const { return primitives_; }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first = 0;  ///< leaf: first primitive; inner: right child (the left one follows its parent)
    std::uint32_t count = 0;  ///< leaf: primitives; inner: 0
  };
  struct Item {
    Eigen::AlignedBox3d box;
    Eigen::Vector3d centre;
    std::uint32_t primitive;
  };

  void build(std::vector<Item>& items, std::uint32_t begin, std::uint32_t end, int depth);
  static std::uint32_t split(std::vector<Item>& items, std::uint32_t begin, std::uint32_t end);

  Primitives primitives_;  // in leaf order
  std::vector<Node> nodes_;
};

}  // namespace igsp::simulation
