#include "simulation/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace igsp::simulation {
namespace {

struct CloudView {
  const Points& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const { return points[index][static_cast<int>(axis)]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

}  // namespace

std::vector<double> nearest_distances(const SimulatedScan& a, const SimulatedScan& b) {
  std::vector<double> distances(a.points.size(), std::numeric_limits<double>::infinity());
  if (b.points.empty()) return distances;
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, CloudView>, CloudView, 3>;
  const CloudView view{b.points};
  const Tree tree(3, view, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  const Transformation b_from_a = b.world_from_scanner.inverse() * a.world_from_scanner;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const Eigen::Vector3d query = b_from_a * a.points[i];
    unsigned int index = 0;
    double squared = 0.0;
    tree.knnSearch(query.data(), 1, &index, &squared);
    distances[i] = std::sqrt(squared);
  }
  return distances;
}

double overlap_of(const SimulatedScan& a, const SimulatedScan& b, double radius) {
  const std::vector<double> distances = nearest_distances(a, b);
  const auto near = std::count_if(distances.begin(), distances.end(), [&](double d) { return d <= radius; });
  return distances.empty() ? 0.0 : static_cast<double>(near) / static_cast<double>(distances.size());
}

}  // namespace igsp::simulation
