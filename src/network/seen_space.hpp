#pragma once

#include <deque>
#include <memory>

#include "network/feature_shelf.hpp"
#include "registration/free_space.hpp"

namespace igsp {

/// What the scanners of a network saw through, asked of any two scans. Keeps what it made ready for some of them; for
/// one thread. Refers to the shelf.
class SeenSpace {
 public:
  explicit SeenSpace(FeatureShelf& features) : features_(features) {}

  /// Both directions, as for a pair; nothing of a scan whose viewpoint is not known.
  FreeSpace at(std::size_t source, std::size_t target, const Transformation& target_from_source);

 private:
  struct Scanned {
    Scanned(std::size_t number, std::shared_ptr<const Features> known)
        : scan(number), features(std::move(known)), space(*features) {}
    std::size_t scan;
    std::shared_ptr<const Features> features;
    ScannedSpace space;
  };
  const Scanned& scanned(std::size_t scan);

  FeatureShelf& features_;
  std::deque<std::unique_ptr<Scanned>> kept_;  // the latest asked last
};

}  // namespace igsp
