#include "estimation/robust_fit.hpp"

#include <vector>

namespace igsp {

double geman_mcclure_weight(double residual, double scale) {
  const double squared = (residual / scale) * (residual / scale);
  if (squared > 9.0) return 0.0;
  return 1.0 / ((1.0 + squared) * (1.0 + squared));
}

std::optional<Transformation> robust_fit(std::span<const PointPair> pairs, const Transformation& initial,
                                         std::span<const double> scales, int degrees_of_freedom) {
  std::vector<PointPair> weighted(pairs.begin(), pairs.end());
  Transformation current = initial;
  for (const double scale : scales) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double residual = (pairs[i].target - current * pairs[i].source).norm();
      weighted[i].weight = pairs[i].weight * geman_mcclure_weight(residual, scale);
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
