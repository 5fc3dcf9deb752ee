#include "registration/pose_refinement.hpp"

#include <array>
#include <span>

#include "registration/point_to_plane.hpp"

namespace igsp {
namespace {

// In a common frame, descriptors of the same place differ by less than about 95 bits; 10 bits of Euclidean distance are
// one voxel at the default suppression radius.
constexpr LoopSchedule::Bounds common_frame_bounds{95.0, 10.0};
constexpr int first_hybrid_k = 4;
constexpr double hybrid_fit_scale = 1.5;  // voxels

constexpr std::array<double, 6> coarse_radii{3, 3, 2, 2, 1.5, 1.5};
constexpr std::size_t coarse_points = 1500;
// The first ones only after an answer at 8 v or 4 v, which may be that far off.
constexpr std::array<double, 9> fine_radii{12, 8, 6, 4, 3, 2, 1.5, 1.5, 1};
constexpr std::array<std::size_t, 4> first_fine_radius{4, 4, 2, 0};  // by rung
// Found at 8 v or 4 v, a pose is refined there first: from further off than a voxel of 4 v the fine surfaces of scan
// lines do not find each other.
constexpr std::size_t finest_settled = 2;  // rung
constexpr std::size_t early_fine_points = 2000;
constexpr std::size_t fine_points = 8000;
constexpr std::size_t max_last_steps = 10;

}  // namespace

LoopOutcome hybrid_loop(CommonFrame& frame, const std::vector<Descriptor>& source_descriptors,
                        const Transformation& initial, int iterations, const Options& options,
                        const std::function<void(int)>& tick) {
  const LoopInput input{frame.source().keypoints,   frame.target().keypoints,          source_descriptors, 1,
                        frame.target_descriptors(), frame.target().features.voxel_size};
  return igsp_loop(input, initial, {first_hybrid_k, iterations, hybrid_fit_scale, common_frame_bounds}, options, tick);
}

Transformation settle(const Surface& source, const Surface& target, const Transformation& initial, double voxel_size,
                      const Options& options) {
  return refine_point_to_plane(
      source, target, initial,
      {coarse_points, coarse_points, coarse_radii, 0, voxel_size, options.degrees_of_freedom, 1});
}

Transformation refined(ScaleLadder& scales, std::size_t rung, const Transformation& target_from_source,
                       const Options& options, bool is_hopeful) {
  Transformation pose = target_from_source;
  for (std::size_t k = rung; k >= finest_settled; --k) {
    CommonFrame& frame = scales.frame(k);
    pose = settle(surface_of(frame.source()), surface_of(frame.target()), pose, scales.voxel_size(k), options);
  }
  FineSurfaces& surfaces = scales.fine_surfaces();
  const auto radii = std::span(fine_radii).subspan(first_fine_radius[rung]);
  return refine_point_to_plane(surfaces.source, surfaces.target, pose,
                               {early_fine_points, is_hopeful ? fine_points : early_fine_points, radii, max_last_steps,
                                scales.voxel_size(0), options.degrees_of_freedom, options.threads});
}

}  // namespace igsp
