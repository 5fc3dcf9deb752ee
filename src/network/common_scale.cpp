#include "network/common_scale.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/scale.hpp"

namespace igsp {

double own_voxel_size(const Scan& scan, const ScaleOptions& options) {
  return choose_voxel_size(scan.points, scan.points, options);
}

double common_voxel_size(std::vector<double> own) {
  if (own.empty()) return 0;
  std::sort(own.begin(), own.end());
  return std::sqrt(own[(own.size() - 1) / 2]) * std::sqrt(own[own.size() / 2]);
}

}  // namespace igsp
