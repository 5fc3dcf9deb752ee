#include "registration/common_frame.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "core/multiversion.hpp"
#include "core/parallel.hpp"
#include "estimation/robust_fit.hpp"
#include "features/bsc.hpp"
#include "igsp/evaluation.hpp"
#include "matching/hamming.hpp"

namespace igsp {
namespace {

constexpr std::size_t looked_at_first = 45;
constexpr double agreeing_distance = 2.5;                        // voxels
constexpr std::array<double, 2> mode_radii{4.0, 8.0};            // voxels
constexpr std::array<double, 4> fit_scales{4.0, 3.0, 2.0, 2.0};  // voxels

// The translation with the most others within `radius`, averaged over those.
Eigen::Vector3d translation_mode(std::span<const PointPair> matches, const Eigen::Matrix3d& rotation, double radius) {
  Points votes;
  for (const PointPair& match : matches) votes.push_back(match.target - rotation * match.source);
  std::size_t most = 0;
  Eigen::Vector3d mode = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vote : votes) {
    std::size_t count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& other : votes) {
      if ((other - vote).squaredNorm() < radius * radius) {
        sum += other;
        ++count;
      }
    }
    if (count > most) {
      most = count;
      mode = sum / static_cast<double>(count);
    }
  }
  return mode;
}

// A distance above an index: the least of them is the nearest, of equally near ones the first.
using Nearest = std::uint32_t;
constexpr int index_bits = 23;  // a distance needs 9
static_assert(bsc_bits < 1 << (32 - index_bits));

std::uint32_t index_of(Nearest nearest) {
  return nearest & ((1u << index_bits) - 1);
}

// The nearest target of source keypoint i, whose distances the row holds; i for every target that it is nearest to.
IGSP_MULTIVERSION Nearest nearest_in_row(const std::uint16_t* row, std::size_t i, std::vector<Nearest>& of_target) {
  Nearest nearest = std::numeric_limits<Nearest>::max();
  Nearest* const target = of_target.data();
  const auto n = static_cast<std::uint32_t>(of_target.size()), source = static_cast<std::uint32_t>(i);
  for (std::uint32_t j = 0; j < n; ++j) {
    const Nearest distance = Nearest{row[j]} << index_bits;
    nearest = std::min(nearest, distance | j);
    target[j] = std::min(target[j], distance | source);
  }
  return nearest;
}

}  // namespace

CommonFrame::CommonFrame(const PreparedCloud& source, const PreparedCloud& target, double descriptor_radius,
                         int threads)
    : source_(source), target_(target), descriptor_radius_(descriptor_radius), threads_(threads) {}

void CommonFrame::describe(std::span<const Transformation> target_from_source, Look look, double reuse_angle_rad) {
  target_descriptors();
  std::vector<Eigen::Matrix3d> rotations;
  for (const Transformation& pose : target_from_source) rotations.push_back(pose.linear());
  describe_source(rotations, look, reuse_angle_rad);
}

const std::vector<Descriptor>& CommonFrame::target_descriptors() {
  if (!target_descriptors_) {
    SupportTable target;
    parallel_pair(
        threads_, [&] { target = gather_supports(target_.grid, target_.keypoints, descriptor_radius_); },
        [&] { source_supports(); });
    const Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    std::vector<Descriptor>* const descriptors = &target_descriptors_.emplace();
    describe_in_frames(target, {}, {&axes, 1}, descriptor_radius_, threads_, {&descriptors, 1});
  }
  return *target_descriptors_;
}

const std::vector<Descriptor>& CommonFrame::source_descriptors(const Eigen::Matrix3d& target_from_source, Look look,
                                                               double reuse_angle_rad) {
  describe_source({&target_from_source, 1}, look, reuse_angle_rad);
  return known(target_from_source, look, reuse_angle_rad)->descriptors;
}

std::size_t CommonFrame::first_look_step() const {
  return std::max<std::size_t>(1, source_.keypoints.size() / looked_at_first);
}

// The nearest one that is described as far as that.
CommonFrame::Cached* CommonFrame::known(const Eigen::Matrix3d& target_from_source, Look look, double reuse_angle_rad) {
  Cached* nearest = nullptr;
  for (Cached& cached : cache_) {
    if (cached.look < look) continue;
    const double angle = rotation_error_rad(cached.rotation, target_from_source);
    if (angle < reuse_angle_rad) nearest = &cached, reuse_angle_rad = angle;
  }
  return nearest;
}

const SupportTable& CommonFrame::source_supports() {
  if (!source_supports_) source_supports_ = gather_supports(source_.grid, source_.keypoints, descriptor_radius_);
  return *source_supports_;
}

void CommonFrame::describe_source(std::span<const Eigen::Matrix3d> target_from_source, Look look,
                                  double reuse_angle_rad) {
  // By what is described of them already.
  std::vector<Cached*> untouched, begun;
  for (const Eigen::Matrix3d& rotation : target_from_source) {
    if (known(rotation, look, reuse_angle_rad) != nullptr) continue;
    if (Cached* cached = known(rotation, Look::first, default_reuse_angle_rad)) {
      cached->look = look;
      begun.push_back(cached);
    } else {
      cache_.push_back({rotation, look, {}});
      untouched.push_back(&cache_.back());
    }
  }
  const auto add = [&](std::span<Cached* const> all, const EveryNth& chosen) {
    if (all.empty()) return;
    std::vector<Eigen::Matrix3d> frames;
    std::vector<std::vector<Descriptor>*> descriptors;
    for (Cached* cached : all) {
      frames.push_back(cached->rotation.transpose());  // the target's axes, seen in the source: the columns of R^T
      descriptors.push_back(&cached->descriptors);
    }
    describe_in_frames(source_supports(), chosen, frames, descriptor_radius_, threads_, descriptors);
  };
  add(untouched, {look == Look::first ? first_look_step() : 1, 0});
  add(begun, {1, first_look_step()});
}

std::vector<PointPair> mutual_matches(CommonFrame& frame, const Eigen::Matrix3d& target_from_source, int threads,
                                      Look look) {
  const auto& all = frame.source_descriptors(target_from_source, look);
  const std::size_t step = look == Look::first ? frame.first_look_step() : 1;
  std::vector<Descriptor> some;
  if (look == Look::first) {
    for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
  }
  const auto& source = look == Look::first ? some : all;
  const auto& target = frame.target_descriptors();
  const std::size_t m = source.size(), n = target.size();
  if (m == 0 || n == 0) return {};
  const std::vector<std::uint16_t> distance = feature_distance_matrix(source, 1, target, threads);
  std::vector<Nearest> of_source(m), of_target(n, std::numeric_limits<Nearest>::max());
  for (std::size_t i = 0; i < m; ++i) of_source[i] = nearest_in_row(&distance[i * n], i, of_target);
  std::vector<PointPair> matches;
  for (std::size_t i = 0; i < m; ++i) {
    const Nearest j = index_of(of_source[i]);
    if (index_of(of_target[j]) == i)
      matches.push_back({frame.source().keypoints[i * step], frame.target().keypoints[j]});
  }
  return matches;
}

namespace {

// Fits from `start` on, and keeps the better of both poses.
void fit_from(const Transformation& start, double voxel_size, int degrees_of_freedom, Rematch& best) {
  std::array<double, fit_scales.size()> scales;
  for (std::size_t i = 0; i < scales.size(); ++i) scales[i] = fit_scales[i] * voxel_size;
  const auto fit = robust_fit(best.matches, start, scales, degrees_of_freedom);
  if (!fit) return;
  const std::size_t agreeing = count_inliers(best.matches, *fit, agreeing_distance * voxel_size);
  if (agreeing <= best.agreeing) return;
  best.agreeing = agreeing;
  best.target_from_source = *fit;
}

Rematch not_moved(const Transformation& hypothesis, std::vector<PointPair> matches, double voxel_size) {
  const std::size_t agreeing = count_inliers(matches, hypothesis, agreeing_distance * voxel_size);
  return {hypothesis, std::move(matches), agreeing, {}};
}

}  // namespace

Rematch rematch(CommonFrame& frame, const Transformation& hypothesis, int degrees_of_freedom, int threads, Look look) {
  const double voxel_size = frame.target().features.voxel_size;
  Rematch best = not_moved(hypothesis, mutual_matches(frame, hypothesis.linear(), threads, look), voxel_size);
  if (best.matches.empty()) return best;
  for (const double radius : mode_radii) {
    Transformation start = hypothesis;
    start.translation() = translation_mode(best.matches, hypothesis.linear(), radius * voxel_size);
    fit_from(start, voxel_size, degrees_of_freedom, best);
  }
  return best;
}

Rematch fit_in_place(const CommonFrame& frame, const Transformation& hypothesis, std::vector<PointPair> matches,
                     int degrees_of_freedom) {
  const double voxel_size = frame.target().features.voxel_size;
  Rematch best = not_moved(hypothesis, std::move(matches), voxel_size);
  fit_from(hypothesis, voxel_size, degrees_of_freedom, best);
  return best;
}

}  // namespace igsp
