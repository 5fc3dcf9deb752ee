#include "estimation/robust_fit.hpp"

#include <vector>

namespace igsp {

std::optional<Transformation> robust_fit(std::span<const PointPair> pairs, const Transformation& initial,
                                         std::span<const double> scales, int degrees_of_freedom) {
  std::vector<PointPair> weighted;
  weighted.reserve(pairs.size());
  Transformation current = initial;
  for (const double scale : scales) {
    weighted.clear();
    for (const PointPair& pair : pairs) {
      const double weight =
          pair.weight * geman_mcclure_weight((pair.target - current * pair.source).squaredNorm(), scale * scale);
      if (weight > 0) weighted.push_back({pair.source, pair.target, weight});
    }
    const auto fit = rigid_fit(weighted, degrees_of_freedom);
    if (!fit) return std::nullopt;
    current = *fit;
  }
  return current;
}

std::size_t count_inliers(std::span<const PointPair> pairs, const Transformation& transformation, double tolerance) {
  std::size_t count = 0;
  for (const PointPair& pair : pairs) {
    count += (pair.target - transformation * pair.source).squaredNorm() < tolerance * tolerance;
  }
  return count;
}

}  // namespace igsp
