#include "files/point_sample.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace igsp::cli {
namespace {

constexpr int hash_bits = 64;
constexpr std::size_t most_sampled = 1'000'000;  // more tell no more of the scale, and cost memory of every large cloud

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

PointSample::PointSample(std::size_t limit, std::size_t expected)
    : limit_(limit), sampled_(std::min(limit / 2, most_sampled)) {
  if (expected > limit) limit_ = std::min(limit, 2 * sampled_);
  kept_.reserve(std::min({limit_, expected, most_sampled}));
}

bool PointSample::is_in(const Eigen::Vector3d& point) const {
  return halvings_ == 0 || hash_of(without_signed_zeros(point)) >> (hash_bits - halvings_) == 0;
}

void PointSample::add(PointView chunk, std::size_t part) {
  sizes_.resize(std::max(sizes_.size(), part + 1));
  seen_ += chunk.size();
  for (const Eigen::Vector3d& point : chunk) {
    if (!is_in(point)) continue;
    kept_.push_back(point);
    ++sizes_[part];
    if (kept_.size() > limit_) shrink();
  }
}

// What is left of every scan, behind what is left of those before it.
template <typename LeaveOut>
void PointSample::keep_of_each(const LeaveOut& leave_out) {
  auto from = kept_.begin(), to = kept_.begin();
  for (std::size_t& size : sizes_) {
    const auto end = from + static_cast<std::ptrdiff_t>(size);
    const auto kept_end = leave_out(from, end);
    size = static_cast<std::size_t>(kept_end - from);
    to = from == to ? kept_end : std::move(from, kept_end, to);
    from = end;
  }
  kept_.erase(to, kept_.end());
}

// As far as any order of the same points would at the end, and no further.
void PointSample::shrink() {
  for (Eigen::Vector3d& point : kept_) point = without_signed_zeros(point);
  keep_of_each([](auto begin, auto end) {
    std::sort(begin, end, comes_before);
    return std::unique(begin, end);  // not of std::ranges, which Clang 14 cannot read
  });
  while (kept_.size() > sampled_ && halvings_ < hash_bits - 1) {
    ++halvings_;
    keep_of_each([this](auto begin, auto end) {
      return std::remove_if(begin, end, [this](const Eigen::Vector3d& point) { return !is_in(point); });
    });
  }
  limit_ = std::min(limit_, 2 * sampled_);
  if (kept_.capacity() > 2 * limit_) kept_ = Points(kept_);
}

Points PointSample::take() {
  if (seen_ > limit_) shrink();
  return std::move(kept_);
}

}  // namespace igsp::cli
