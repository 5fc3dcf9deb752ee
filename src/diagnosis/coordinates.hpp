#pragma once

#include <optional>

#include "igsp/diagnosis.hpp"
#include "spatial/bounds.hpp"

namespace igsp {

/// The coordinates of a refused pair. Each question is answered in time linear in the points, and names the cloud that
/// is to blame, or both.
class PairCoordinates {
 public:
  PairCoordinates(PointView source, PointView target, int threads);

  std::optional<Diagnosis> too_few() const;

  std::optional<Diagnosis> flat() const;

  /// x and y within the range of longitude and latitude, far from their origin for their extent, and far smaller in
  /// extent than the heights.
  std::optional<Diagnosis> degrees() const;

  /// Every coordinate of an axis is a multiple of a step, which is more than a quarter of a voxel.
  std::optional<Diagnosis> coarse(double voxel_size) const;

 private:
  struct Cloud {
    PointView points;
    Bounds bounds;
  };
  /// question(cloud) of both, at the same time where there are threads for it.
  template <typename Question>
  auto of_both(const Question& question) const;

  int threads_;
  Cloud source_, target_;
};

}  // namespace igsp
