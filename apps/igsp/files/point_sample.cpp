#include "files/point_sample.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace igsp::cli {
namespace {

constexpr int hash_bits = 64;

// The finaliser of SplitMix64: every bit of the input moves half of the output's.
std::uint64_t mixed(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9ull;
  bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBull;
  return bits ^ (bits >> 31);
}

std::uint64_t hash_of(const Eigen::Vector3d& point) {
  std::uint64_t hash = 0;
  for (const double coordinate : point)
    hash = mixed(hash + 0x9E3779B97F4A7C15ull + std::bit_cast<std::uint64_t>(coordinate));
  return hash;
}

bool comes_before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

// Equal numbers have equal bits then: -0 becomes 0.
Eigen::Vector3d without_signed_zeros(const Eigen::Vector3d& point) {
  return point.array() + 0.0;
}

}  // namespace

bool PointSample::is_in(const Eigen::Vector3d& point) const {
  return halvings_ == 0 || hash_of(without_signed_zeros(point)) >> (hash_bits - halvings_) == 0;
}

void PointSample::add(PointView chunk) {
  seen_ += chunk.size();
  for (const Eigen::Vector3d& point : chunk) {
    if (is_in(point)) kept_.push_back(point);
    if (kept_.size() > limit_) shrink();
  }
}

// As far as any order of the same points would at the end, and no further.
void PointSample::shrink() {
  for (Eigen::Vector3d& point : kept_) point = without_signed_zeros(point);
  std::ranges::sort(kept_, comes_before);
  kept_.erase(std::unique(kept_.begin(), kept_.end()), kept_.end());  // not of std::ranges, which Clang 14 cannot read
  while (kept_.size() > limit_ / 2 && halvings_ < hash_bits - 1) {
    ++halvings_;
    std::erase_if(kept_, [this](const Eigen::Vector3d& point) { return !is_in(point); });
  }
}

Points PointSample::take() {
  if (seen_ > limit_) shrink();
  return std::move(kept_);
}

}  // namespace igsp::cli
