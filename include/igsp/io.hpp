#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp {

enum class FileFormat {
  ply_ascii,
  ply_binary_little_endian,
  ply_binary_big_endian,
  pcd_ascii,
  pcd_binary,
  pcd_binary_compressed,
  las,  ///< only read; written by nothing but a moved copy of a LAS file
  text
};

struct ReadOptions {
  /// Text files: which columns are x, y and z, by their names or their numbers from 1. Empty: found by their names
  /// (X [m], Easting, Height, ...), else the first three.
  std::vector<std::string> columns;
  /// LAS: whether points that are classified as noise (7, 18) or withheld are read as well.
  bool keep_noise = false;
};

/// Reads the points of a file in chunks: PLY (ascii, both byte orders), PCD (ascii, binary, binary_compressed), LAS
/// without compression (1.0 to 1.4, point formats 0 to 10) and text (XYZ, TXT, CSV, ASC, PTS and the like). The content
/// decides between them, for text the extension. Properties other than x, y, z are skipped. Non-finite points are
/// dropped and counted, and so is the noise of LAS. A file that declares 0 points is an empty
/// cloud, no error. Memory is bounded by a chunk whatever the file's size, save for PCD binary_compressed, whose body
/// (at most 4 GiB) can only be decompressed whole.
class PointReader {
 public:
  static constexpr std::size_t default_chunk = 65536;

  /// Opens the file and reads its header. Throws FileError (path and line or byte offset).
  explicit PointReader(const std::filesystem::path& path, std::size_t points_per_chunk = default_chunk,
                       const ReadOptions& options = {});
  ~PointReader();
  PointReader(PointReader&&) noexcept;
  PointReader& operator=(PointReader&&) noexcept;

  /// The next chunk of finite points, empty at the end; valid until the next call. Throws FileError.
  PointView next_chunk();

  FileFormat format() const;
  std::size_t dropped() const;          ///< non-finite points met so far
  std::size_t noise() const;            ///< points of LAS left out so far: classified as noise (7, 18) or withheld
  std::size_t declared_points() const;  ///< the header's count; 0 where the format has none
  /// Where the file says that the scanner stood: VIEWPOINT of a PCD unless it is the default, `comment viewpoint x y z`
  /// of a PLY.
  std::optional<Eigen::Vector3d> viewpoint() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

struct LoadedCloud {
  operator Scan() const { return {points, viewpoint}; }

  Points points;
  std::optional<Eigen::Vector3d> viewpoint;  ///< where the file says that the scanner stood
  std::size_t dropped = 0;                   ///< non-finite points left out
  std::size_t noise = 0;                     ///< points of LAS left out: classified as noise (7, 18) or withheld
  FileFormat format = FileFormat::ply_binary_little_endian;
};

/// The whole cloud. Throws FileError.
LoadedCloud read_points(const std::filesystem::path& path, const ReadOptions& options = {});

struct WriteOptions {
  std::optional<FileFormat> format = {};  ///< by default the one that the extension stands for
  bool single_precision = false;          ///< coordinates rounded to float
  /// Where the scanner stood; PLY and PCD keep it, text does not. PCD cannot tell the origin from not knowing.
  std::optional<Eigen::Vector3d> viewpoint = {};
};

/// The format that a path's extension stands for: .ply and .pcd binary, .las, .xyz, .txt, .csv, .asc, .pts and the like
/// text. Throws FileError otherwise.
FileFormat format_of(const std::filesystem::path& path);

/// Writes to a temporary name beside `path`, then renames: nothing half-written is left. Every format reads back as
/// exactly the same coordinates, save LAS, which is not written. Throws FileError, and InvalidArgument for a coordinate
/// that is not finite (as a float).
void write_points(const std::filesystem::path& path, PointView points, const WriteOptions& options = {});

/// The same for points that come in chunks, `count` in all, in memory of a chunk (PCD binary_compressed: of the whole).
void write_points(const std::filesystem::path& path, std::size_t count, const ChunkSource& chunks,
                  const WriteOptions& options = {});

/// 4x4 row-major text, as in `T.txt`: 16 numbers, or the 12 of its upper three rows, over any lines; # starts a
/// comment. Throws FileError (also if the matrix is not a rigid motion to 1e-3). The numbers are taken as they are.
Transformation read_transformation(const std::filesystem::path& path);
/// `scale`: the source is multiplied by it first, p_target = transformation * (scale * p_source). What then is no rigid
/// motion is not read back.
void write_transformation(const std::filesystem::path& path, const Transformation& transformation, double scale = 1.0);

}  // namespace igsp
