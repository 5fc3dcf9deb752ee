#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "igsp/features.hpp"
#include "igsp/options.hpp"
#include "spatial/point_grid.hpp"

namespace igsp::profile {

/// A piece of igsp beside the least that any program has to do for the same answer.
struct Kernel {
  std::string name;
  std::uint64_t work = 0;  ///< how often the least is done
  std::function<void()> run, least;
};

/// The voxel filter beside reading its points once, the Hamming distances beside one popcount a word, the normals
/// beside touching each neighbour once; on the features of a pair.
class Kernels {
 public:
  Kernels(const Points& source, const Points& target, const Options& options);
  Kernels(const Kernels&) = delete;  // its functions hold its address
  Kernels& operator=(const Kernels&) = delete;

  std::vector<Kernel> all() const;
  /// The instruction set that the Hamming kernel runs with here.
  std::string vectors() const;

 private:
  const Points& cloud_;
  Features source_, target_;
  double pca_radius_;
  PointGrid grid_;
  std::uint64_t neighbours_ = 0;
};

}  // namespace igsp::profile
