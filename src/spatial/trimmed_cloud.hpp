#pragma once

#include "spatial/bounds.hpp"

namespace igsp {

/// A cloud without its stray points. Axis after axis what lies beyond a gap is left out, again until no axis has one.
/// Does not depend on the order of the points.
class TrimmedCloud {
 public:
  /// Refers to `cloud` where nothing is left out. Throws as bounds_of.
  TrimmedCloud(PointView cloud, std::string_view name);

  PointView points() const { return kept_.empty() ? given_ : PointView(kept_); }
  const Bounds& bounds() const { return bounds_; }  ///< of `points`
  const StrayPoints& stray() const { return stray_; }
  std::size_t count_kept(PointView given) const;  ///< how many of these points of the cloud as given are in `points`
  TrimmedCloud in_unit(double unit) const;        ///< the same, all lengths divided by `unit`, a power of two

 private:
  PointView given_;
  Points kept_;
  Bounds bounds_;
  StrayPoints stray_;
};

}  // namespace igsp
