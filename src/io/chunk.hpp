#pragma once

#include <cmath>
#include <cstddef>

#include "igsp/point_cloud.hpp"

namespace igsp::io {

/// What the readers fill: finite points up to a limit; the others, and noise, are only counted.
struct Chunk {
  Points points;
  std::size_t limit = 0;
  std::size_t dropped = 0;
  std::size_t noise = 0;

  bool full() const { return points.size() >= limit; }
  void add(double x, double y, double z) {
    if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z)) {
      points.emplace_back(x, y, z);
    } else {
      ++dropped;
    }
  }
};

}  // namespace igsp::io
