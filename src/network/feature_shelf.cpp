#include "network/feature_shelf.hpp"

#include <algorithm>
#include <utility>

namespace igsp {

FeatureShelf::FeatureShelf(std::size_t scans, FeatureSource source, std::size_t held)
    : source_(std::move(source)), held_(held == 0 ? scans : held), features_(scans) {}

std::shared_ptr<const Features> FeatureShelf::get(std::size_t scan) {
  if (features_[scan]) {
    asked_.erase(std::ranges::find(asked_, scan));
  } else {
    features_[scan] = std::make_shared<const Features>(source_(scan));
    if (asked_.size() == held_) {
      features_[asked_.front()].reset();
      asked_.pop_front();
    }
  }
  asked_.push_back(scan);
  return features_[scan];
}

}  // namespace igsp
