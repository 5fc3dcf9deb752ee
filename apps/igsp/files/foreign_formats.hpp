#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp::cli {

/// A cloud being read by somebody else.
struct ForeignCloud {
  std::string format;  ///< what people call it, such as "LAZ"
  ChunkSource next_chunk;
  std::function<std::size_t()> dropped;  ///< non-finite points met so far
  std::function<std::size_t()> noise;    ///< points of LAZ left out so far: classified as noise, or withheld
  std::function<std::size_t()> part;     ///< of which `parts` the latest chunk is: all of its points, in their order
  // After the last chunk:
  std::function<std::optional<Eigen::Vector3d>()> viewpoint;  ///< where the file says that the scanner stood
  std::function<std::vector<ScanPart>()> parts;               ///< of a file of several scans: what it says of each
};

/// How LAS stores a coordinate: offset + scale * an integer of 32 bits.
struct CoordinateGrid {
  Eigen::Vector3d offset;
  double scale;
};

/// Files that igsp cannot read or write by itself, and who can: the Python package fills this, the plain command has
/// none of it. All may throw FileError.
struct ForeignFormats {
  std::function<bool(const std::filesystem::path&)> reads;
  std::function<ForeignCloud(const std::filesystem::path&, bool keep_noise)> open;
  /// The names of the scans in a file, by which `open` takes each of them alone: FILE#0, FILE#1, ...; the file itself
  /// where it holds a single one.
  std::function<std::vector<std::string>(const std::filesystem::path&)> scans;
  /// Whether `source` can be written moved as `output`, with all that belongs to its points.
  std::function<bool(const std::filesystem::path& source, const std::filesystem::path& output)> moves;
  std::function<void(const std::filesystem::path& source, const std::filesystem::path& output, const Transformation&)>
      write_moved;
  /// Whether x, y and z alone can be written under this name.
  std::function<bool(const std::filesystem::path&)> writes_points;
  std::function<void(const std::filesystem::path&, const ChunkSource&, const CoordinateGrid&)> write_points;
  /// Called in a signal handler when the user asks to stop, so that what runs here does; may be null.
  void (*on_interrupt)() = nullptr;
};

/// Those of this process: it runs one command line. Set before any command runs, not changed later.
void use_foreign_formats(ForeignFormats formats);

/// Not one of igsp's own formats, but one of theirs: also a LAS file whose points are compressed.
bool reads_foreign(const std::filesystem::path& path);
/// Theirs, unless igsp moves it by itself.
bool moves_foreign(const std::filesystem::path& source, const std::filesystem::path& output);
/// Both LAS without compression, which igsp moves by itself on the grid of integers that the source has.
bool moves_las(const std::filesystem::path& source, const std::filesystem::path& output);
ForeignCloud open_foreign(const std::filesystem::path& path, bool keep_noise);

/// Its scans, each to be read by itself. Of a file that cannot be read, the file: reading it says why.
std::vector<std::filesystem::path> scans_in(const std::filesystem::path& path);

/// FILE of FILE#0.
std::filesystem::path file_of_scan(const std::filesystem::path& scan);
void write_moved_foreign(const std::filesystem::path& source, const std::filesystem::path& output,
                         const Transformation& target_from_source);

/// Whether they write x, y and z alone under this name; igsp itself does so as PLY, PCD and text.
bool writes_foreign_points(const std::filesystem::path& path);
/// Chunk by chunk. Throws FileError.
void write_foreign_points(const std::filesystem::path& path, const ChunkSource& chunks, const CoordinateGrid& grid);

/// Throws FileError that says where help is, if `path` is of a format that only the Python package reads and writes and
/// nobody here does.
void check_not_foreign(const std::filesystem::path& path);

}  // namespace igsp::cli
