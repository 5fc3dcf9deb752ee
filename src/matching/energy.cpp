#include "matching/energy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"
#include "matching/hamming.hpp"
#include "spatial/point_grid.hpp"

namespace igsp {
namespace {

std::span<const Descriptor> variants_of(const KeypointSets& keypoints, std::size_t source) {
  return keypoints.source_variants.subspan(source * keypoints.variants, keypoints.variants);
}

// k = 0: CD = FD for every pair, however far apart.
std::vector<AssignmentEdge> edges_by_feature(const KeypointSets& keypoints, double threshold, int threads) {
  const std::int64_t limit = to_assignment_units(threshold);
  std::vector<AssignmentEdge> edges;
  for (const FeaturePair& pair : feature_pairs_below(keypoints.source_variants, keypoints.variants,
                                                     keypoints.target_descriptors, threshold, threads)) {
    const std::int64_t cost = to_assignment_units(pair.distance);
    if (cost < limit) edges.push_back({pair.source, pair.target, cost});  // a threshold may round down to its cost
  }
  return edges;
}

// Largest distance of a keypoint from the local origin; 1 if there is none.
double extent_of(const KeypointSets& keypoints) {
  double squared = 0;
  for (const Eigen::Vector3d& point : keypoints.source) squared = std::max(squared, point.squaredNorm());
  for (const Eigen::Vector3d& point : keypoints.target) squared = std::max(squared, point.squaredNorm());
  return squared > 0 ? std::sqrt(squared) : 1.0;
}

// CD < T implies |p - q| < T / (s_ed W_ed), as FD >= 0: a radius search finds every candidate.
std::vector<AssignmentEdge> edges_by_distance(const KeypointSets& keypoints, double ed_scale,
                                              const EnergyWeights& weights, double threshold, int threads) {
  const std::int64_t limit = to_assignment_units(threshold);
  if (limit <= 0) return {};
  const double extent = extent_of(keypoints);
  const double radius = std::min(threshold / (ed_scale * weights.ed), 3 * extent);  // twice the extent reaches everyone
  // A margin for the grid's coordinates in single precision; the exact test follows in double.
  const float reach = static_cast<float>(1.001 * radius + 1e-6 * extent);
  const PointGrid grid(keypoints.target, radius);
  std::vector<std::vector<AssignmentEdge>> rows(keypoints.source.size());
  parallel_blocks(rows.size(), threads, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      grid.visit_sphere(keypoints.source[i].cast<float>(), reach, [&](std::uint32_t position, float) {
        const std::uint32_t j = grid.index[position];
        const double ed = ed_scale * (keypoints.source[i] - keypoints.target[j]).norm();
        if (weights.ed * ed >= threshold) return;
        const double fd = feature_distance(variants_of(keypoints, i), keypoints.target_descriptors[j]);
        const std::int64_t cost = to_assignment_units(weights.fd * fd + weights.ed * ed);
        if (cost < limit) rows[i].push_back({static_cast<std::uint32_t>(i), j, cost});
      });
      std::sort(rows[i].begin(), rows[i].end(), [](const auto& a, const auto& b) { return a.target < b.target; });
    }
  });
  std::vector<AssignmentEdge> edges;
  for (const auto& row : rows) edges.insert(edges.end(), row.begin(), row.end());
  return edges;
}

struct Means {
  double ed, fd, ed_rms, fd_deviation;
};

Means means_of(std::span<const Correspondence> matched, double ed_scale) {
  double ed = 0, ed2 = 0, fd = 0, fd2 = 0;
  for (const Correspondence& c : matched) {
    const double scaled = ed_scale * c.euclidean_distance;
    ed += scaled;
    ed2 += scaled * scaled;
    fd += c.feature_distance;
    fd2 += c.feature_distance * c.feature_distance;
  }
  const double n = static_cast<double>(matched.size());
  return {ed / n, fd / n, std::sqrt(ed2 / n), std::sqrt(std::max(0.0, fd2 / n - fd / n * (fd / n)))};
}

}  // namespace

EnergyWeights energy_weights(int k, double weight_changing_rate) {
  const double fd = std::exp(-k / weight_changing_rate);
  return {fd, 1.0 - fd};
}

DistanceSpread feature_distance_spread(const KeypointSets& keypoints, int threads) {
  const FeatureDistanceStatistics statistics = feature_distance_statistics(
      feature_distance_histogram(keypoints.source_variants, keypoints.variants, keypoints.target_descriptors, threads));
  return {statistics.mean, statistics.sigma};
}

DistanceSpread compound_distance_spread(const KeypointSets& keypoints, double ed_scale, const EnergyWeights& weights,
                                        int threads) {
  std::vector<double> sums(keypoints.source.size(), 0), sums2(keypoints.source.size(), 0);
  parallel_blocks(sums.size(), threads, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = 0; j < keypoints.target.size(); ++j) {
        const double fd = feature_distance(variants_of(keypoints, i), keypoints.target_descriptors[j]);
        const double ed = ed_scale * (keypoints.source[i] - keypoints.target[j]).norm();
        const double cd = weights.fd * fd + weights.ed * ed;
        sums[i] += cd;
        sums2[i] += cd * cd;
      }
    }
  });
  const double n = static_cast<double>(keypoints.source.size()) * static_cast<double>(keypoints.target.size());
  const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) / n;
  const double mean2 = std::accumulate(sums2.begin(), sums2.end(), 0.0) / n;
  return {mean, std::sqrt(std::max(0.0, mean2 - mean * mean))};
}

double initial_threshold(const DistanceSpread& spread, const EnergyOptions& options) {
  return std::max(options.min_threshold, spread.mean - options.p1 * spread.sigma);
}

double next_threshold(std::span<const Correspondence> matched, double ed_scale, const EnergyWeights& weights,
                      double previous, const EnergyOptions& options) {
  if (matched.empty()) return previous;
  const Means mean = means_of(matched, ed_scale);
  const double threshold = options.threshold_rule == ThresholdRule::paper
                               ? options.p2 * weights.ed * mean.ed + options.p3 * weights.fd * mean.fd
                               : weights.ed * mean.ed_rms * options.released_p_ed +
                                     weights.fd * (mean.fd + options.released_p_fd * mean.fd_deviation);
  return std::max(options.min_threshold, threshold);
}

std::vector<AssignmentEdge> candidate_edges(const KeypointSets& keypoints, double ed_scale,
                                            const EnergyWeights& weights, double threshold, int threads) {
  return weights.ed == 0 ? edges_by_feature(keypoints, threshold, threads)
                         : edges_by_distance(keypoints, ed_scale, weights, threshold, threads);
}

std::vector<Correspondence> correspondences_of(const Assignment& assignment, const KeypointSets& keypoints) {
  std::vector<Correspondence> correspondences;
  for (std::uint32_t i = 0; i < assignment.target_of_source.size(); ++i) {
    if (assignment.target_of_source[i] < 0) continue;
    const auto j = static_cast<std::uint32_t>(assignment.target_of_source[i]);
    const double fd = feature_distance(variants_of(keypoints, i), keypoints.target_descriptors[j]);
    correspondences.push_back({i, j, fd, (keypoints.source[i] - keypoints.target[j]).norm()});
  }
  return correspondences;
}

void update_distances(std::span<Correspondence> correspondences, const KeypointSets& keypoints) {
  for (Correspondence& c : correspondences) {
    c.euclidean_distance = (keypoints.source[c.source] - keypoints.target[c.target]).norm();
  }
}

double matching_energy(const Assignment& assignment, const KeypointSets& keypoints, double threshold) {
  // The solver charges T_cd for an unmatched source and nothing for an unmatched target.
  const double size_difference =
      static_cast<double>(keypoints.target.size()) - static_cast<double>(keypoints.source.size());
  return bits_from_assignment_units(assignment.energy) + 0.5 * threshold * size_difference;
}

}  // namespace igsp
