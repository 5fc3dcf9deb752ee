#include "matching/candidates.hpp"

#include <algorithm>
#include <cmath>

#include "features/bsc.hpp"
#include "features/bsc_layout.hpp"
#include "matching/hamming.hpp"

namespace igsp {
namespace {

struct Spread {
  double mean = 0, sigma = 0;
  double stands_out(double value) const { return sigma > 0 ? (mean - value) / sigma : 0.0; }
};

struct Sums {
  double sum = 0, sum2 = 0;
  void add(double value) {
    sum += value;
    sum2 += value * value;
  }
  Spread spread(std::size_t n) const {
    const double mean = sum / static_cast<double>(n);
    return {mean, std::sqrt(std::max(0.0, sum2 / static_cast<double>(n) - mean * mean))};
  }
};

// Keeps the `limit` smallest values offered, ties to the one offered first.
struct Best {
  std::vector<std::pair<std::uint16_t, std::uint32_t>> items;
  void offer(std::uint16_t value, std::uint32_t index, std::size_t limit) {
    if (items.size() == limit && value >= items.back().first) return;
    if (items.size() == limit) items.pop_back();
    auto place = items.end();
    while (place != items.begin() && (place - 1)->first > value) --place;
    items.insert(place, {value, index});
  }
};

Eigen::Quaternionf frame_rotation(const Eigen::Matrix3d& source_frame, const Eigen::Matrix3d& target_frame,
                                  int frame_flip) {
  const auto& signs = bsc::frame_flips[frame_flip].signs;
  const Eigen::Matrix3d flipped_source = source_frame * Eigen::Vector3d(signs[0], signs[1], signs[2]).asDiagonal();
  return Eigen::Quaternionf(Eigen::Quaterniond(Eigen::Matrix3d(target_frame * flipped_source.transpose())));
}

int best_variant(std::span<const Descriptor> variants, const Descriptor& target) {
  int best = 0;
  for (int v = 1; v < static_cast<int>(variants.size()); ++v) {
    if (feature_distance(variants.subspan(v, 1), target) < feature_distance(variants.subspan(best, 1), target))
      best = v;
  }
  return best;
}

}  // namespace

std::vector<Candidate> feature_candidates(const DescribedKeypoints& source, const DescribedKeypoints& target,
                                          int variants, int per_keypoint, int max_candidates, int threads) {
  const std::size_t m = source.positions.size(), n = target.positions.size();
  if (m == 0 || n == 0) return {};
  const std::vector<Descriptor> source_variants = sign_variants(source.descriptors, variants);
  const std::vector<std::uint16_t> distance =
      feature_distance_matrix(source_variants, variants, target.descriptors, threads);

  std::vector<Sums> row_sums(m), column_sums(n);
  std::vector<Best> row_best(m), column_best(n);
  const std::size_t limit = per_keypoint;
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const std::uint16_t d = distance[i * n + j];
      row_sums[i].add(d);
      column_sums[j].add(d);
      row_best[i].offer(d, static_cast<std::uint32_t>(j), limit);
      column_best[j].offer(d, static_cast<std::uint32_t>(i), limit);
    }
  }

  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t i = 0; i < m; ++i) {
    for (const auto& item : row_best[i].items) pairs.emplace_back(i, item.second);
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (const auto& item : column_best[j].items) pairs.emplace_back(item.second, j);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

  std::vector<Spread> rows(m), columns(n);
  for (std::size_t i = 0; i < m; ++i) rows[i] = row_sums[i].spread(n);
  for (std::size_t j = 0; j < n; ++j) columns[j] = column_sums[j].spread(m);
  struct Scored {
    double score;
    std::uint32_t source, target;
  };
  std::vector<Scored> scored;
  for (const auto& [i, j] : pairs) {
    const double d = distance[i * n + j];
    scored.push_back({rows[i].stands_out(d) + columns[j].stands_out(d), i, j});
  }
  std::stable_sort(scored.begin(), scored.end(), [](const Scored& a, const Scored& b) { return a.score > b.score; });
  if (scored.size() > static_cast<std::size_t>(max_candidates)) scored.resize(max_candidates);

  std::vector<Candidate> candidates;
  candidates.reserve(scored.size());
  for (const Scored& s : scored) {
    const std::span<const Descriptor> own{&source_variants[std::size_t{s.source} * variants],
                                          static_cast<std::size_t>(variants)};
    const int flip = best_variant(own, target.descriptors[s.target]);
    candidates.push_back({s.source, s.target, static_cast<float>(s.score),
                          frame_rotation(source.frames[s.source], target.frames[s.target], flip)});
  }
  return candidates;
}

}  // namespace igsp
