#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <span>
#include <vector>

namespace igsp {

/// Points in contiguous storage, metres (any unit of length works: nothing inside has a unit of its own).
using Points = std::vector<Eigen::Vector3d>;

/// A view of such points; a C-contiguous (N, 3) float64 array can be viewed without a copy.
using PointView = std::span<const Eigen::Vector3d>;

/// Hands out a cloud in pieces: every call returns the next chunk, an empty one at the end. A chunk is valid until the
/// next call. Lets the voxel filter run over clouds that do not fit in memory.
using ChunkSource = std::function<PointView()>;

/// A rigid transformation. Named after its direction: p_target = target_from_source * p_source.
using Transformation = Eigen::Isometry3d;

}  // namespace igsp
