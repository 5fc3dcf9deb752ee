#include "network/seen_space.hpp"

#include <algorithm>

namespace igsp {
namespace {

constexpr std::size_t most_kept = 16;

}  // namespace

const SeenSpace::Scanned& SeenSpace::scanned(std::size_t scan) {
  const auto found = std::ranges::find(kept_, scan, [](const auto& kept) { return kept->scan; });
  if (found != kept_.end()) {
    std::rotate(found, found + 1, kept_.end());
    return *kept_.back();
  }
  if (kept_.size() == most_kept) kept_.pop_front();
  kept_.push_back(std::make_unique<Scanned>(scan, features_.get(scan)));
  return *kept_.back();
}

FreeSpace SeenSpace::at(std::size_t source, std::size_t target, const Transformation& target_from_source) {
  const Scanned &a = scanned(source), &b = scanned(target);  // of those that are kept the one before stays
  Transformation local = target_from_source;                 // between the centred clouds
  local.translation() += local.linear() * a.features->origin - b.features->origin;
  return free_space_between(a.space, b.space, local);
}

}  // namespace igsp
