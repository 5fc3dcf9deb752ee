#include "network/likeness.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "features/bsc.hpp"
#include "matching/hamming.hpp"

namespace igsp {
namespace {

// The most curved of a scan: 100 rank pairs as well as 400 do (docs/network.md).
constexpr std::size_t keypoints_that_vote = 128;

// The least distance of every voter of a scan to those of another.
std::vector<double> nearest_distances(std::span<const Descriptor> variants, std::size_t flips,
                                      const std::vector<Descriptor>& other) {
  std::vector<double> distances(variants.size() / flips, 0);
  feature_distance_rows(variants, flips, other, 1, [&](std::size_t voter, std::span<const std::uint16_t> row) {
    distances[voter] = *std::ranges::min_element(row);
  });
  return distances;
}

// How far a keypoint's nearest neighbour in one scan stands out among those in all others, squared and in sigmas, as
// the mean over the keypoints: a place that is seen again is far nearer than places that are only of the same kind.
std::vector<double> votes_of(std::size_t i, std::span<const std::vector<Descriptor>> scans, std::size_t flips) {
  std::vector<double> votes(scans.size(), 0);
  const std::vector<Descriptor> variants = sign_variants(scans[i], static_cast<int>(flips));
  std::vector<std::vector<double>> distances(scans.size());
  std::size_t others = 0;
  for (std::size_t j = 0; j < scans.size(); ++j) {
    if (j == i || scans[j].empty()) continue;
    distances[j] = nearest_distances(variants, flips, scans[j]);
    ++others;
  }
  const std::size_t count = variants.size() / flips;
  for (std::size_t voter = 0; voter < count; ++voter) {
    double sum = 0, squares = 0;
    for (const std::vector<double>& to : distances) {
      if (to.empty()) continue;
      sum += to[voter];
      squares += to[voter] * to[voter];
    }
    const double mean = sum / static_cast<double>(others);
    const double sigma = std::sqrt(std::max(1.0, squares / static_cast<double>(others) - mean * mean));
    for (std::size_t j = 0; j < scans.size(); ++j) {
      if (distances[j].empty()) continue;
      const double nearer = std::max(0.0, (mean - distances[j][voter]) / sigma);
      votes[j] += nearer * nearer / static_cast<double>(count);
    }
  }
  return votes;
}

}  // namespace

std::vector<Descriptor> voters_of(const Features& scan) {
  const std::size_t count = std::min(keypoints_that_vote, scan.descriptors.size());
  return {scan.descriptors.begin(), scan.descriptors.begin() + count};
}

std::vector<double> likeness_of_scans(std::span<const std::vector<Descriptor>> scans, int degrees_of_freedom,
                                      int threads) {
  const std::size_t n = scans.size();
  const std::size_t flips = degrees_of_freedom == 4 ? 2 : 4;
  std::vector<std::vector<double>> votes(n);
  parallel_blocks(n, threads, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) votes[i] = votes_of(i, scans, flips);
  });
  std::vector<double> likeness(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) likeness[i * n + j] = (votes[i][j] + votes[j][i]) / 2;
  }
  return likeness;
}

}  // namespace igsp
