#include "archive/consistency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "archive/bytes.hpp"

namespace igsp::archive {
namespace {

constexpr double max_voxels_from_centre = 1 << 20;  // as the voxel filter has it
constexpr double max_unit = 1.001;                  // an entry of a unit vector that was rounded

void require(bool holds, std::string_view what) {
  if (!holds) throw Fault(fmt::format("it contradicts itself: {}", what));
}

template <typename Values, typename Others>
void require_one_each(const Values& values, std::string_view name, const Others& others, std::string_view owner) {
  require(values.size() == others.size(), fmt::format("{} {} for {} {}", values.size(), name, others.size(), owner));
}

template <typename Matrices>
void require_entries_up_to(double limit, const Matrices& matrices, std::string_view name) {
  // Written so that NaN does not pass.
  const bool all = std::ranges::all_of(matrices, [&](const auto& m) { return (m.array().abs() <= limit).all(); });
  require(all, fmt::format("an entry of {} is not finite or beyond {}", name, limit));
}

void require_indices_below(std::size_t size, const std::vector<KeypointMatch>& matches, auto side) {
  const bool all = std::ranges::all_of(matches, [&](const KeypointMatch& match) { return match.*side < size; });
  require(all, "a correspondence of a keypoint that is not there");
}

}  // namespace

void require_consistent(const Features& features) {
  require(std::isfinite(features.voxel_size) && features.voxel_size >= 0, "voxel_size is negative or not finite");
  require(features.origin.allFinite(), "origin is not finite");
  require(!features.viewpoint || features.viewpoint->allFinite(), "viewpoint is not finite");
  for (const ScannedPart& part : features.parts) {
    require(part.viewpoint.allFinite(), "viewpoint of a part is not finite");
    require_entries_up_to(max_voxels_from_centre * features.voxel_size, part.fine_points, "fine_points of a part");
  }
  require_one_each(features.curvature, "curvatures", features.points, "points");
  require_one_each(features.normals, "normals", features.points, "points");
  require_one_each(features.frames, "frames", features.keypoints, "keypoints");
  require_one_each(features.descriptors, "descriptors", features.keypoints, "keypoints");
  const bool indices =
      std::ranges::all_of(features.keypoints, [&](std::uint32_t i) { return i < features.points.size(); });
  require(indices, "a keypoint is none of its points");
  require_entries_up_to(max_voxels_from_centre * features.voxel_size, features.points, "points");
  require_entries_up_to(max_voxels_from_centre * features.voxel_size, features.fine_points, "fine_points");
  require_entries_up_to(max_unit, features.normals, "normals");
  require_entries_up_to(max_unit, features.frames, "frames");
  require(std::ranges::all_of(features.curvature, [](float value) { return std::isfinite(value); }),
          "a curvature is not finite");
  double voxel_size = features.voxel_size;
  for (const Features& coarser : features.coarser) {
    voxel_size *= 2;
    require(coarser.voxel_size == voxel_size, "coarser voxels are not twice as large as those before");
    require(coarser.coarser.empty(), "coarser voxels of coarser voxels");
    require_consistent(coarser);
  }
}

void require_consistent(const Result& result) {
  for (const IterationRecord& record : result.iterations) {
    require_indices_below(result.source_keypoints.size(), record.correspondences, &KeypointMatch::source);
    require_indices_below(result.target_keypoints.size(), record.correspondences, &KeypointMatch::target);
  }
}

void require_consistent(const Network& network) {
  const auto is_scan = [&](std::size_t i) { return i < network.scans.size(); };
  require(std::ranges::all_of(network.scans, [&](auto& scan) { return scan.component < network.components.size(); }),
          "a scan of a component that is not there");
  require(std::ranges::all_of(network.components,
                              [&](auto& scans) { return !scans.empty() && std::ranges::all_of(scans, is_scan); }),
          "a component without scans, or of one that is not there");
  require(std::ranges::all_of(network.links,
                              [&](auto& link) {
                                return is_scan(link.source) && is_scan(link.target) &&
                                       std::ranges::all_of(link.merged, is_scan);
                              }),
          "a link of a scan that is not there");
  require(
      std::ranges::all_of(network.contradictions, [&](auto& pair) { return std::ranges::all_of(pair.scans, is_scan); }),
      "a contradiction of a scan that is not there");
}

}  // namespace igsp::archive
