#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "igsp/io.hpp"
#include "igsp/progress.hpp"

namespace igsp::io {

struct MoveOptions {
  ReadOptions read;
  bool doubles = false;       ///< float coordinates are written as doubles; integer ones always are
  ProgressCallback progress;  ///< stage "write"
  /// Where the scanner of `source` is known to have stood, in its frame: takes the place of what the file says. Without
  /// it the default VIEWPOINT of a PCD, which everyone writes who does not know, stays: moved it would claim something.
  std::optional<Eigen::Vector3d> viewpoint = {};
};

/// Whether `destination` can hold all that `source` does: both PLY, both PCD, both LAS, or both text of the same kind.
/// Throws FileError where `source` cannot be opened or `destination` is of no known format.
bool keeps_properties(const std::filesystem::path& source, const std::filesystem::path& destination);

/// What belongs to the points of a PLY, PCD, LAS or text file beside x, y and z, by its names; PLY elements with their
/// count. Throws FileError.
std::vector<std::string> other_properties(const std::filesystem::path& source, const ReadOptions& options = {});

/// Writes `source`, moved, in the format that it has: coordinates change, normals and other directions turn, the
/// viewpoint that a PCD or a PLY states moves, and so do scale, offset and bounds of a LAS; every other byte is a copy:
/// properties, faces, comments, cells without a point. A value that does not change keeps its text. Memory is bounded
/// whatever the size, save for PCD binary_compressed, whose body is one block. The linear part may hold a factor of
/// scale, which directions do not take. Nothing half-written is left. Throws FileError, also where records that hold no
/// points are cut short, and Cancelled. Returns whether coordinates are of another type than in `source`.
bool write_moved(const std::filesystem::path& source, const std::filesystem::path& destination,
                 const Transformation& destination_from_source, const MoveOptions& options = {});

}  // namespace igsp::io
