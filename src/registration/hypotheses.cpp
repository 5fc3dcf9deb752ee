#include "registration/hypotheses.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/parallel.hpp"
#include "estimation/robust_fit.hpp"
#include "igsp/evaluation.hpp"
#include "matching/consistent_assignment.hpp"

namespace igsp {
namespace {

constexpr std::size_t max_seeds = 400;
constexpr std::size_t max_subset = 30;
constexpr double min_agreement = 0.75;
constexpr double inlier_tolerance = 2.5;  // voxels

struct Ranked {
  std::int64_t score;
  std::uint32_t candidate;
};

void sort_by_score(std::vector<Ranked>& ranked) {
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return a.score != b.score ? a.score > b.score : a.candidate < b.candidate;
  });
}

// S(c) = sum over the neighbours c' of c of |N(c) and N(c')|: candidates in large, dense agreement first.
std::vector<Ranked> ranked_seeds(const ConsistencyGraph& graph) {
  std::vector<Ranked> seeds(graph.size());
  for (std::uint32_t c = 0; c < graph.size(); ++c) seeds[c] = {graph.degree(c), c};
  sort_by_score(seeds);
  if (seeds.size() > max_seeds) seeds.resize(max_seeds);
  for (Ranked& seed : seeds) {
    seed.score = 0;
    graph.visit_neighbours(seed.candidate,
                           [&](std::size_t c) { seed.score += graph.common_neighbours(seed.candidate, c); });
  }
  sort_by_score(seeds);
  return seeds;
}

// The seed and those of its neighbours that agree with at least 75 % of the members so far, best connected first.
std::vector<std::uint32_t> consistent_subset(const ConsistencyGraph& graph, std::uint32_t seed) {
  std::vector<Ranked> neighbours;
  graph.visit_neighbours(seed, [&](std::size_t c) {
    neighbours.push_back({graph.common_neighbours(seed, c), static_cast<std::uint32_t>(c)});
  });
  sort_by_score(neighbours);
  std::vector<std::uint32_t> subset{seed};
  for (const Ranked& neighbour : neighbours) {
    const auto agreeing = std::count_if(subset.begin(), subset.end(),
                                        [&](std::uint32_t member) { return graph.agree(member, neighbour.candidate); });
    if (static_cast<double>(agreeing) >= min_agreement * static_cast<double>(subset.size())) {
      subset.push_back(neighbour.candidate);
    }
    if (subset.size() == max_subset) break;
  }
  return subset;
}

// The pairs of the one assignment that the whole graph prefers, weighted by their support.
std::vector<PointPair> preferred_by_all(std::span<const Candidate> candidates, const ConsistencyGraph& graph,
                                        std::span<const PointPair> pairs, std::size_t sources, std::size_t targets) {
  const std::vector<double> weights = consistency_weights(graph);
  std::vector<PointPair> preferred;
  for (const std::uint32_t c : consistent_assignment(candidates, weights, sources, targets)) {
    preferred.push_back({pairs[c].source, pairs[c].target, weights[c]});
  }
  return preferred;
}

}  // namespace

bool same_pose(const Transformation& a, const Transformation& b, const Eigen::Vector3d& centre, double voxel_size) {
  constexpr double max_angle_rad = 5.0 * M_PI / 180.0;
  constexpr double max_distance = 4.0;  // voxels
  return rotation_error_rad(a.linear(), b.linear()) < max_angle_rad &&
         (a * centre - b * centre).norm() < max_distance * voxel_size;
}

std::vector<Hypothesis> propose_hypotheses(std::span<const Candidate> candidates, const ConsistencyGraph& graph,
                                           PointView source, PointView target, double voxel_size,
                                           const Options& options) {
  std::vector<PointPair> pairs;
  for (const Candidate& c : candidates) pairs.push_back({source[c.source], target[c.target]});
  const double tolerance = inlier_tolerance * voxel_size;
  const std::array<double, 5> scales{6 * voxel_size, 4 * voxel_size, 3 * voxel_size, 2 * voxel_size, 2 * voxel_size};

  // Of a subset first, then of all pairs robustly from there.
  const auto fit_to = [&](std::span<const PointPair> subset) -> std::optional<Transformation> {
    const auto initial = rigid_fit(subset, options.degrees_of_freedom);
    return initial ? robust_fit(pairs, *initial, scales, options.degrees_of_freedom) : std::nullopt;
  };
  std::vector<Hypothesis> hypotheses;
  // Kept unless it repeats an earlier one at `place`.
  const auto propose = [&](const std::optional<Transformation>& fit, const Eigen::Vector3d& place) {
    if (!fit) return;
    const bool repeated = std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& h) {
      return same_pose(h.target_from_source, *fit, place, voxel_size);
    });
    if (!repeated) hypotheses.push_back({*fit, count_inliers(pairs, *fit, tolerance)});
  };
  const auto is_explained = [&](const PointPair& seed) {
    return std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& h) {
      return (seed.target - h.target_from_source * seed.source).norm() < tolerance;
    });
  };
  std::optional<Transformation> preferred;
  std::vector<Ranked> seeds;
  parallel_pair(
      options.threads,
      [&] { preferred = fit_to(preferred_by_all(candidates, graph, pairs, source.size(), target.size())); },
      [&] { seeds = ranked_seeds(graph); });
  propose(preferred, Eigen::Vector3d::Zero());
  // The next seeds that nothing explains yet are fitted at the same time, one for each thread, and then asked in their
  // order as if each had waited for those before it.
  std::vector<std::uint32_t> next;
  for (auto seed = seeds.begin(); seed != seeds.end();) {
    next.clear();
    for (; seed != seeds.end() && next.size() < concurrency(options.threads); ++seed) {
      if (!is_explained(pairs[seed->candidate])) next.push_back(seed->candidate);
    }
    std::vector<std::optional<Transformation>> fits(next.size());
    parallel_blocks(next.size(), options.threads, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::vector<PointPair> subset;
        for (const std::uint32_t c : consistent_subset(graph, next[i])) subset.push_back(pairs[c]);
        fits[i] = fit_to(subset);
      }
    });
    for (std::size_t i = 0; i < next.size(); ++i) {
      if (hypotheses.size() == static_cast<std::size_t>(options.hypotheses.max_proposed)) return hypotheses;
      if (!is_explained(pairs[next[i]])) propose(fits[i], pairs[next[i]].source);
    }
  }
  return hypotheses;
}

}  // namespace igsp
