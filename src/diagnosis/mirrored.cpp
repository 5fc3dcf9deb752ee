#include "diagnosis/mirrored.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "igsp/align.hpp"

namespace igsp {
namespace {

// Whether there is an answer is asked, not how exact it is: fewer hypotheses and, where enough voxels are left, the
// coarser scale keep the price well below that of the pair itself.
constexpr int max_proposed = 16;
constexpr std::size_t enough_voxels = 4000;

// Any plane will do, the others differ by a rigid motion. Across a vertical one a levelled scan stays levelled.
const Eigen::Vector3d reflection(-1, 1, 1);

}  // namespace

std::optional<Diagnosis> mirrored(const Scan& source, const Scan& target, const Result& refused,
                                  const ProgressCallback& progress) {
  Points image(source.points.begin(), source.points.end());
  for (Eigen::Vector3d& point : image) point = point.cwiseProduct(reflection);
  std::optional<Eigen::Vector3d> viewpoint = source.viewpoint;
  if (viewpoint) *viewpoint = viewpoint->cwiseProduct(reflection);
  Options options = refused.options;
  const bool coarser = std::min(refused.source.voxels, refused.target.voxels) >= enough_voxels;
  options.scale.voxel_size = (coarser ? 2 : 1) * refused.voxel_size;
  options.hypotheses.max_proposed = std::min(options.hypotheses.max_proposed, max_proposed);
  const Result result = align({image, viewpoint}, target, options, progress);
  if (!result.registered) return std::nullopt;

  Eigen::Matrix4d target_from_source = result.target_from_source.matrix();
  target_from_source.leftCols<3>() *= reflection.asDiagonal();
  return Diagnosis{Cause::mirrored,
                   fmt::format("the mirrored source would register (confidence {:.3f}): one of the clouds is "
                               "left-handed; negate one of its axes or exchange two, unless the scene itself is "
                               "symmetric",
                               result.confidence),
                   target_from_source};
}

}  // namespace igsp
