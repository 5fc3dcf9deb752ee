#include "network/seen_space.hpp"

#include <algorithm>

namespace igsp {
namespace {

constexpr std::size_t most_kept = 16;
constexpr std::size_t looks = 1000;

}  // namespace

const SeenSpace::Scanned* SeenSpace::scanned(std::size_t scan) {
  const auto found = std::ranges::find(kept_, scan, [](const auto& kept) { return kept->scan; });
  if (found != kept_.end()) {
    std::rotate(found, found + 1, kept_.end());
    return kept_.back().get();
  }
  if (unknown_.contains(scan)) return nullptr;
  auto made = std::make_unique<Scanned>(scan, features_.get(scan));
  if (!made->space.is_known()) {
    unknown_.insert(scan);
    return nullptr;
  }
  if (kept_.size() == most_kept) kept_.pop_front();
  kept_.push_back(std::move(made));
  return kept_.back().get();
}

std::optional<SeenTogether> SeenSpace::at(std::size_t source, std::size_t target,
                                          const Transformation& target_from_source) {
  const Scanned *a = scanned(source), *b = scanned(target);  // of those that are kept the one before stays
  if (!a || !b) return {};
  Transformation local = target_from_source;  // between the centred clouds
  local.translation() += local.linear() * a->features->origin - b->features->origin;
  const std::size_t source_meets = b->space.met_by(a->space, local, looks),
                    target_meets = a->space.met_by(b->space, local.inverse(), looks);
  return SeenTogether{free_space_between(a->space, b->space, local, looks), std::min(source_meets, target_meets)};
}

}  // namespace igsp
