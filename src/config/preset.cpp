#include "config/preset.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/nearest.hpp"
#include "igsp/errors.hpp"
#include "igsp/options.hpp"

namespace igsp {
namespace {

// The paper's Table 1 with its Algorithm 1. Where the paper gives no figure (the radii in units of the voxel, the
// gates) stand the multiples that registered most with the paper's loop alone; docs/method.md.
Options paper() {
  Options options;
  options.search = Search::direct;
  options.refinement.enabled = false;
  options.keypoints.pca_radius = 6.0;
  options.keypoints.suppression_radius = 4.0;
  options.keypoints.max_eigenvalue_ratio = 0.8;
  options.keypoints.min_neighbours = 20;
  options.keypoints.min_curvature = 0.01;
  options.descriptor.radius = 10.0;
  options.energy.distance_scale = 30.0;
  options.energy.weight_changing_rate = 8.0;
  options.energy.threshold_rule = ThresholdRule::paper;
  options.energy.p1 = 2.5;
  options.energy.p2 = 1.5;
  options.energy.p3 = 1.25;
  return options;
}

}  // namespace

std::span<const std::string_view> preset_names() {
  static constexpr std::string_view names[] = {"default", "paper"};
  return names;
}

Options preset(std::string_view name) {
  if (name == "default") return Options{};
  if (name == "paper") return paper();
  throw InvalidArgument(fmt::format("unknown preset \"{}\"; did you mean \"{}\"? Known: {}", name,
                                    nearest(name, preset_names()), fmt::join(preset_names(), ", ")));
}

}  // namespace igsp
