#include "matching/length_ratios.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace igsp {
namespace {

constexpr std::size_t max_candidates = 1000;   // those that stand out most
constexpr double min_rotation_cosine = 0.924;  // of half the angle between two frames' rotations: 45 degrees
constexpr double min_direction_cosine = 0.94;  // 20 degrees
constexpr double largest_log = 0.405;          // of the factor: 3/2
constexpr int vote_bins = 81;                  // of 1 %
constexpr int peak_reach = 2;                  // bins beside the peak that belong to it

// In double precision: in which order Eigen sums up three floats depends on the processor.
struct Pose {
  Eigen::Vector3d source, target;
  Eigen::Quaterniond rotation;
};

std::vector<Pose> best_of(std::span<const Candidate> candidates, PointView source, PointView target) {
  std::vector<Pose> poses;
  for (const Candidate& c : candidates.first(std::min(max_candidates, candidates.size()))) {
    poses.push_back({source[c.source], target[c.target], c.target_from_source.cast<double>()});
  }
  return poses;
}

std::array<double, vote_bins> votes_of(std::span<const Pose> poses, double min_length) {
  std::array<double, vote_bins> votes{};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (std::abs(poses[i].rotation.dot(poses[j].rotation)) < min_rotation_cosine) continue;
      const Eigen::Vector3d a = poses[i].source - poses[j].source, b = poses[i].target - poses[j].target;
      const double from = a.norm(), to = b.norm();
      if (from < min_length || to < min_length) continue;
      const double along = std::max((poses[i].rotation * a).dot(b), (poses[j].rotation * a).dot(b));
      if (along < min_direction_cosine * from * to) continue;
      const double at = (std::log(to / from) / largest_log + 1) * 0.5 * vote_bins;
      if (at >= 0 && at < vote_bins) ++votes[static_cast<std::size_t>(at)];
    }
  }
  return votes;
}

double sum_around(const std::array<double, vote_bins>& votes, int centre, int radius) {
  double sum = 0;
  for (int k = std::max(0, centre - radius); k <= std::min(vote_bins - 1, centre + radius); ++k) sum += votes[k];
  return sum;
}

}  // namespace

RatioPeak ratio_peak(std::span<const Candidate> candidates, PointView source, PointView target, double min_length) {
  const auto votes = votes_of(best_of(candidates, source, target), min_length);
  RatioPeak best;
  for (int centre = peak_reach; centre < vote_bins - peak_reach; ++centre) {
    const double inside = sum_around(votes, centre, peak_reach);
    // What lies beside, in a window five times as wide.
    const int wide = 5 * peak_reach + 2;
    const double width = std::min(vote_bins - 1, centre + wide) - std::max(0, centre - wide) + 1;
    const double expected =
        (sum_around(votes, centre, wide) - inside) / (width - (2 * peak_reach + 1)) * (2 * peak_reach + 1);
    const double prominence = (inside - expected) / std::sqrt(expected + 1);
    if (prominence <= best.prominence) continue;
    double mean = 0;
    for (int k = centre - peak_reach; k <= centre + peak_reach; ++k) mean += votes[k] * (k + 0.5) / inside;
    best = {std::exp((mean / (0.5 * vote_bins) - 1) * largest_log), prominence};
  }
  return best;
}

}  // namespace igsp
