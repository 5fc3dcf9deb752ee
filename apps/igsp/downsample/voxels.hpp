#pragma once

#include <filesystem>

#include "files/cloud_input.hpp"

namespace igsp::cli {

/// The voxel centroids of a file, in its frame: boundaries lie at multiples of the voxel size, so that tiles of one
/// survey share their voxels. Where the cloud lies too far from the origin for that, they lie at multiples from the one
/// nearest to its centre, which takes a second pass. Throws FileError, Cancelled, and InvalidArgument for voxels too
/// small for the extent.
CloudInput voxels_of(const std::filesystem::path& path, double voxel_size, const ProgressCallback& progress,
                     const ReadOptions& options);

}  // namespace igsp::cli
