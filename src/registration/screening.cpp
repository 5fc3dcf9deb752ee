#include "registration/screening.hpp"

#include <algorithm>
#include <numeric>

#include "registration/each_pose.hpp"

namespace igsp {
namespace {

constexpr std::size_t enough_agreeing = 15;
constexpr double enough_agreement = 0.6;
constexpr double rival_inliers = 0.5;  // of the winner's
// A first look with every fourth keypoint: of 678 searches of real pairs that had a pose to find, its best eight of 24
// proposals had it in 675.
constexpr std::size_t looked_into_at_once = 3, looked_into = 8;
constexpr std::size_t largest_stride = 4, least_keypoints = 40;

bool is_clear(const Rematch& match) {
  return match.agreeing >= enough_agreeing &&
         static_cast<double>(match.agreeing) >= enough_agreement * static_cast<double>(match.matches.size());
}

std::vector<Transformation> poses_of(std::span<const Hypothesis> hypotheses) {
  std::vector<Transformation> poses;
  for (const Hypothesis& hypothesis : hypotheses) poses.push_back(hypothesis.target_from_source);
  return poses;
}

// The best by how many matches of a part of the keypoints agree, best first.
std::vector<Hypothesis> promising(CommonFrame& frame, std::span<const Hypothesis> hypotheses, int degrees_of_freedom) {
  const std::size_t stride = std::min(largest_stride, frame.source_keypoints().size() / least_keypoints);
  if (stride < 2 || hypotheses.size() <= looked_into) return {hypotheses.begin(), hypotheses.end()};
  CommonFrame thin = frame.thinned(stride);
  const std::vector<std::size_t> agreeing = look_into_each<std::size_t>(
      thin, poses_of(hypotheses),
      [&](const Transformation& pose) { return rematch(thin, pose, degrees_of_freedom, 1).agreeing; });
  std::vector<std::size_t> order(hypotheses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return agreeing[i]; });
  std::vector<Hypothesis> best;
  for (const std::size_t i : std::span(order).first(looked_into)) best.push_back(hypotheses[i]);
  return best;
}

class Screening {
 public:
  Screening(CommonFrame& frame, int degrees_of_freedom) : frame_(frame), degrees_of_freedom_(degrees_of_freedom) {}

  // All of a batch or, after a clear winner, those that could be its rivals.
  void match_again(std::span<const Hypothesis> batch) {
    std::vector<Hypothesis> wanted;
    std::ranges::copy_if(batch, std::back_inserter(wanted), [this](const Hypothesis& hypothesis) {
      return static_cast<double>(hypothesis.inliers) >= rival_inliers * static_cast<double>(winner_inliers_);
    });
    std::vector<Rematch> found = look_into_each<Rematch>(frame_, poses_of(wanted), [this](const Transformation& pose) {
      return rematch(frame_, pose, degrees_of_freedom_, 1);
    });
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (is_clear(found[i])) winner_inliers_ = std::max(winner_inliers_, wanted[i].inliers);
      matched_.push_back(std::move(found[i]));
    }
  }
  bool has_clear_winner() const { return winner_inliers_ > 0; }

  std::vector<Rematch> sorted() && {
    std::ranges::stable_sort(matched_, std::greater(), &Rematch::agreeing);
    return std::move(matched_);
  }

 private:
  CommonFrame& frame_;
  int degrees_of_freedom_;
  std::vector<Rematch> matched_;
  std::size_t winner_inliers_ = 0;
};

}  // namespace

std::vector<Rematch> screen(CommonFrame& frame, std::vector<Hypothesis> hypotheses, const Options& options,
                            const std::function<void(double)>& tick) {
  Screening screening(frame, options.degrees_of_freedom);
  // In batches that grow, for the winner is mostly among the first.
  for (std::size_t begin = 0, size = 1; begin < hypotheses.size(); begin += size, size *= 2) {
    if (begin == looked_into_at_once && !screening.has_clear_winner()) {
      const auto best = promising(frame, std::span(hypotheses).subspan(begin), options.degrees_of_freedom);
      hypotheses.resize(begin);
      hypotheses.insert(hypotheses.end(), best.begin(), best.end());
    }
    tick(static_cast<double>(begin) / static_cast<double>(hypotheses.size()));
    screening.match_again(std::span(hypotheses).subspan(begin, std::min(size, hypotheses.size() - begin)));
  }
  return std::move(screening).sorted();
}

}  // namespace igsp
