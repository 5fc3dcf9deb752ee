#pragma once

#include <span>
#include <vector>

#include "features/support.hpp"
#include "igsp/features.hpp"

namespace igsp {

/// Binary Shape Context of a support seen in a frame (columns x, y, n): for each of the three coordinate planes the
/// occupancy of 7 x 7 cells, and for 48 pairs of cells whether their difference in depth and in density stands out
/// (Dong et al. 2017, as specified in docs/method.md). Depth is signed, so that turning the frame's signs permutes
/// bits.
Descriptor binary_shape_context(const SupportView& support, const Eigen::Matrix3d& frame, double descriptor_radius);

/// Descriptor in the frame with the signs of frame flip 0..3 (bsc_layout.hpp), by permuting bits: no point is touched.
Descriptor flipped(const Descriptor& descriptor, int frame_flip);

/// The variants of every descriptor, row-major (descriptors x variants): flips 0..3, or 0..1 for levelled frames.
std::vector<Descriptor> sign_variants(std::span<const Descriptor> descriptors, int variants);

/// Every so many of the places, from the first one on, save those that are among every so many others.
struct EveryNth {
  std::size_t step = 1, but_not = 0;  ///< 0: no others
  bool has(std::size_t place) const { return place % step == 0 && (but_not == 0 || place % but_not != 0); }
};

/// Descriptors of many places in `descriptors`[frame][place], each frame being common to all of them: no local one
/// takes part. Of the places that are chosen; the others stay as they are.
void describe_in_frames(const SupportTable& supports, const EveryNth& chosen, std::span<const Eigen::Matrix3d> frames,
                        double descriptor_radius, int threads, std::span<std::vector<Descriptor>* const> descriptors);

}  // namespace igsp
