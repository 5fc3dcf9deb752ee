#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "igsp/io.hpp"
#include "igsp/progress.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"
#include "io/scalar_type.hpp"

namespace igsp::io {

struct RowField {
  std::string name;
  ScalarType type = ScalarType::float64;
};

/// A cloud as rows of numbers: a row a point, with all that belongs to it.
struct RowSource {
  std::vector<RowField> fields;
  std::array<std::size_t, 3> coordinates{};  ///< which fields are x, y and z
  std::optional<Eigen::Vector3d> viewpoint = {};
  std::vector<std::string> left_out = {};  ///< what rows of numbers cannot hold, in words: "12 x face"
  /// Fills the next row, also one that is not finite; false at the end. Throws FileError, also for an integer that a
  /// double cannot hold (beyond 2^53).
  std::function<bool(std::span<double> row)> next = {};
};

/// The rows of a PLY, PCD, LAS or text file, which must outlive them. Colours that PCD packs into one number are red,
/// green, blue (and alpha), normals are nx, ny and nz, whatever the file calls them. Numbers of text files are doubles;
/// a cell without one is not a number. Throws FileError.
RowSource open_rows(InputFile& file, const ReadOptions& options);

struct RowOutput {
  FileFormat format = FileFormat::text;
  std::string extension;           ///< in lower case: tells the kinds of text apart
  std::uint64_t count = 0;         ///< rows whose coordinates are finite: only these are written
  ProgressCallback progress = {};  ///< stage "write"
};

/// Writes them under the names that programs expect in this format. Throws FileError, Cancelled.
void write_rows(AtomicFile& file, RowSource& rows, const RowOutput& output);

// One for each family of formats.
RowSource open_ply_rows(InputFile& file);
RowSource open_pcd_rows(InputFile& file);
RowSource open_las_rows(InputFile& file, bool keep_noise);
RowSource open_text_rows(InputFile& file, const std::vector<std::string>& columns);

/// How one value is read: it is passed over where `field` is none.
struct RowValue {
  ScalarType type = ScalarType::float32;
  std::optional<std::size_t> field = {};
  std::optional<ScalarType> list_length = {};  ///< a list: passed over
};

/// The next `count` records of these values, one behind the other.
std::function<bool(std::span<double>)> binary_rows(InputFile& file, std::vector<RowValue> values, std::uint64_t count,
                                                   std::endian byte_order);

/// A number in a row. Fails for an integer that a double cannot hold.
double checked_value(const InputFile& file, double value, ScalarType type);

}  // namespace igsp::io
