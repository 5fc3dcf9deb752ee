#include "igsp/similarity.hpp"

#include <cmath>

#include "registration/scale_votes.hpp"
#include "registration/similarity_search.hpp"

namespace igsp {
namespace {

constexpr int max_fits = 4;
constexpr double settled = 1e-4;  // of the logarithm of a step: no point moves by more than a fraction of the noise
constexpr double sensible = 0.3;  // of the logarithm of a step, which must follow from a pose that is nearly right
constexpr std::size_t max_tried = 3;

SimilarityResult at_factor(const Scan& source, const Scan& target, double factor, const Options& options,
                           const ProgressCallback& progress) {
  const ScaledScan scaled(source, factor);
  SimilarityResult similarity{factor, 0, align(scaled.scan(), target, options, progress)};
  if (similarity.result.registered) similarity.sigma = factor * similarity.result.precision.scale_sigma;
  return similarity;
}

}  // namespace

// Steps by what the surfaces at the pose say of the scale, as long as that is a step from a pose near the right one.
SimilarityResult similarity_near(const Scan& source, const Scan& target, double factor, const Options& options,
                                 const ProgressCallback& progress) {
  SimilarityResult similarity = at_factor(source, target, factor, options, progress);
  for (int step = 0; step < max_fits; ++step) {
    const Precision& precision = similarity.result.precision;
    const double growth = std::abs(std::log(precision.scale));
    if (!(precision.scale_sigma > 0) || growth < settled || growth > sensible) break;
    SimilarityResult next = at_factor(source, target, similarity.factor * precision.scale, options, progress);
    const bool is_better = next.result.registered || next.result.confidence > similarity.result.confidence;
    if (!is_better) break;  // what a wrong pose says of the scale leads nowhere
    similarity = std::move(next);
  }
  return similarity;
}

Eigen::Matrix4d SimilarityResult::matrix() const {
  Eigen::Matrix4d matrix = result.target_from_source.matrix();
  matrix.topLeftCorner<3, 3>() *= factor;
  return matrix;
}

SimilarityResult align_similarity(const Scan& source, const Scan& target, const Options& options,
                                  const ProgressCallback& progress) {
  SimilarityResult as_given = similarity_near(source, target, 1.0, options, progress);
  if (as_given.result.registered) return as_given;
  std::vector<double> factors = voted_factors(source, target, options, progress);
  if (factors.size() > max_tried) factors.resize(max_tried);
  for (const double factor : factors) {
    SimilarityResult found = similarity_near(source, target, factor, options, progress);
    if (found.result.registered) return found;
  }
  return as_given;
}

}  // namespace igsp
