#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "files/foreign_formats.hpp"
#include "igsp/io.hpp"

namespace igsp::cli {

/// A cloud in a file, in chunks of finite points: by igsp's own readers or, where they do not know the format, by those
/// that were handed to the command.
class CloudFile {
 public:
  /// Throws FileError.
  explicit CloudFile(const std::filesystem::path& path, const ReadOptions& options = {});

  /// Empty at the end; valid until the next call. Throws FileError.
  PointView next_chunk();

  std::string format() const;           ///< for people: "PLY, ascii"
  std::size_t dropped() const;          ///< non-finite points met so far
  std::size_t noise() const;            ///< points of LAS and LAZ left out so far: noise and withheld ones
  std::size_t part() const;             ///< of which `parts` the latest chunk is
  std::size_t declared_points() const;  ///< 0 where the format or its reader does not say
  // After the last chunk:
  std::optional<Eigen::Vector3d> viewpoint() const;  ///< where the file says that its scanner stood
  std::vector<ScanPart> parts() const;               ///< of a file of several scans: what it says of each

 private:
  std::variant<PointReader, ForeignCloud> reader_;
};

}  // namespace igsp::cli
