#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <set>

#include "network/feature_shelf.hpp"
#include "registration/free_space.hpp"

namespace igsp {

/// Two scans where a network puts them.
struct SeenTogether {
  FreeSpace free_space;
  std::size_t meeting = 0;  ///< voxels of one, of about 1000, that lie on the surface of the other; the fewer
};

/// What the scanners of a network saw through, asked of any two scans. Keeps what it made ready for some of them; for
/// one thread. Refers to the shelf.
class SeenSpace {
 public:
  explicit SeenSpace(FeatureShelf& features) : features_(features) {}

  /// Nothing unless both viewpoints are known.
  std::optional<SeenTogether> at(std::size_t source, std::size_t target, const Transformation& target_from_source);

 private:
  struct Scanned {
    Scanned(std::size_t number, std::shared_ptr<const Features> known)
        : scan(number), features(std::move(known)), space(*features) {}
    std::size_t scan;
    std::shared_ptr<const Features> features;
    ScannedSpace space;
  };
  const Scanned* scanned(std::size_t scan);

  FeatureShelf& features_;
  std::deque<std::unique_ptr<Scanned>> kept_;  // the latest asked last
  std::set<std::size_t> unknown_;              // scans whose viewpoint is not known
};

}  // namespace igsp
