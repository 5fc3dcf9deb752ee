#include "simulation/bounding_volume_hierarchy.hpp"

#include <algorithm>
#include <array>

namespace igsp::simulation {
namespace {

constexpr std::uint32_t leaf_size = 4;
constexpr int bins = 16;
constexpr int max_area_splits = 64;  // deeper nodes are halved, which bounds the depth
constexpr int max_depth = max_area_splits + 32;

/// Where the ray enters the box; infinity when it misses it or enters beyond `limit`.
double entry(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& inverse_direction,
             double limit) {
  double enter = 0.0, leave = limit;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.min()[i] - origin[i]) * inverse_direction[i];
    const double b = (box.max()[i] - origin[i]) * inverse_direction[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

double half_area(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return 0.0;
  const Eigen::Vector3d s = box.sizes();
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

struct Bin {
  Eigen::AlignedBox3d box;
  std::uint32_t count = 0;

  void add(const Bin& other) {
    box.extend(other.box);
    count += other.count;
  }
};

/// Expected work of a split before each bin but the first: area times number of primitives, summed over both sides.
std::array<double, bins> split_costs(const std::array<Bin, bins>& filled) {
  std::array<double, bins> cost{};
  Bin left, right;
  for (int i = 1; i < bins; ++i) {
    left.add(filled[i - 1]);
    cost[i] += half_area(left.box) * left.count;
  }
  for (int i = bins - 1; i > 0; --i) {
    right.add(filled[i]);
    cost[i] += half_area(right.box) * right.count;
  }
  return cost;
}

}  // namespace

BoundingVolumeHierarchy::BoundingVolumeHierarchy(const Primitives& primitives) {
  std::vector<Item> items;
  items.reserve(primitives.size());
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    Eigen::AlignedBox3d box = bounds(primitives[i]);
    // Rounding in the slab test must not lose a surface that lies in a face of its own box.
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(1e-9 + 1e-12 * box.max().cwiseAbs().maxCoeff());
    box.min() -= margin;
    box.max() += margin;
    items.push_back({box, box.center(), i});
  }
  nodes_.reserve(primitives.size());
  if (!items.empty()) build(items, 0, static_cast<std::uint32_t>(items.size()), 0);
  primitives_.reserve(primitives.size());
  for (const Item& item : items) primitives_.push_back(primitives[item.primitive]);
}

void BoundingVolumeHierarchy::build(std::vector<Item>& items, std::uint32_t begin, std::uint32_t end, int depth) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  for (std::uint32_t i = begin; i < end; ++i) nodes_[self].box.extend(items[i].box);
  if (end - begin <= leaf_size) {
    nodes_[self].first = begin;
    nodes_[self].count = end - begin;
    return;
  }
  const std::uint32_t middle = depth < max_area_splits ? split(items, begin, end) : begin + (end - begin) / 2;
  build(items, begin, middle, depth + 1);
  nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
  build(items, middle, end, depth + 1);
}

std::uint32_t BoundingVolumeHierarchy::split(std::vector<Item>& items, std::uint32_t begin, std::uint32_t end) {
  Eigen::AlignedBox3d centres;
  for (std::uint32_t i = begin; i < end; ++i) centres.extend(items[i].centre);
  int axis = 0;
  const double width = centres.sizes().maxCoeff(&axis);
  const auto bin_of = [&](const Item& item) {
    const double share = (item.centre[axis] - centres.min()[axis]) / width;
    return std::min(bins - 1, static_cast<int>(share * bins));
  };
  if (width > 0.0) {
    std::array<Bin, bins> filled;
    for (std::uint32_t i = begin; i < end; ++i) filled[bin_of(items[i])].add({items[i].box, 1});
    const auto cost = split_costs(filled);
    const int best = static_cast<int>(std::min_element(cost.begin() + 1, cost.end()) - cost.begin());
    const auto middle = std::partition(items.begin() + begin, items.begin() + end,
                                       [&](const Item& item) { return bin_of(item) < best; });
    return static_cast<std::uint32_t>(middle - items.begin());  // the end bins are never empty, so neither side is
  }
  return begin + (end - begin) / 2;  // all centres coincide: any halving will do
}

Hit BoundingVolumeHierarchy::first_hit(const Ray& ray, double max_distance) const {
  Hit hit;
  double limit = max_distance;
  const Eigen::Vector3d inverse = ray.direction.cwiseInverse();
  std::array<std::uint32_t, max_depth> waiting;
  int waiting_count = 0;
  if (!nodes_.empty() && entry(nodes_[0].box, ray.origin, inverse, limit) < limit) waiting[waiting_count++] = 0;
  while (waiting_count > 0) {
    const std::uint32_t index = waiting[--waiting_count];
    const Node& node = nodes_[index];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double distance = first_crossing(primitives_[i], ray);
      if (distance < limit) limit = distance, hit = {distance, i};
    }
    if (node.count > 0) continue;
    std::uint32_t near = index + 1, far = node.first;
    double near_entry = entry(nodes_[near].box, ray.origin, inverse, limit);
    double far_entry = entry(nodes_[far].box, ray.origin, inverse, limit);
    if (far_entry < near_entry) std::swap(near, far), std::swap(near_entry, far_entry);
    if (far_entry < limit) waiting[waiting_count++] = far;
    if (near_entry < limit) waiting[waiting_count++] = near;
  }
  return hit;
}

}  // namespace igsp::simulation
