#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "igsp/point_cloud.hpp"
#include "io/input_file.hpp"
#include "io/moved_fields.hpp"
#include "io/scalar_type.hpp"

namespace igsp::io {

/// A value of a record, by its name; several of them (PCD's COUNT) or a list of varying length are nothing that moves.
struct RecordField {
  std::string name;
  ScalarType type = ScalarType::float32;
  std::size_t count = 1;
  std::optional<ScalarType> list_length = {};
};

/// What of a record moves, and the types that its values are written as: integer positions become doubles, since moved
/// ones are none, and so do float positions where they were asked to.
struct RecordMotion {
  std::vector<MovedFields> moved;
  std::vector<ScalarType> written;  ///< of every field
  bool changes_types = false;       ///< some are others than in the file
};

RecordMotion motion_of(const std::vector<RecordField>& fields, bool doubles);

/// One of the three values, in record i at its offset + i * step.
struct MovedValue {
  ScalarType read = ScalarType::float32, written = ScalarType::float32;
  std::size_t read_offset = 0, read_step = 0;
  std::size_t written_offset = 0, written_step = 0;
};

/// Moves three values in each of `count` records; those that stay keep their bytes where they keep their type. Fails as
/// `require_held` does.
void move_values(const InputFile& file, const std::array<MovedValue, 3>& values, bool direction, std::endian byte_order,
                 const Transformation& transformation, std::uint64_t count, const char* read, char* written);

/// Records of one size, one behind the other.
class FixedMotion {
 public:
  FixedMotion(const std::vector<RecordField>& fields, const RecordMotion& motion, std::endian byte_order);

  std::size_t read_size() const { return read_size_; }
  /// Appends `count` moved records. Fails as `require_held` does.
  void append(const InputFile& file, const char* records, std::uint64_t count, const Transformation& transformation,
              std::string& bytes) const;

 private:
  struct Run {
    std::size_t read_offset, written_offset, size;
  };

  std::endian byte_order_;
  std::size_t read_size_ = 0, written_size_ = 0;
  std::vector<Run> kept_;  // what lies between values that change their type
  std::vector<std::array<MovedValue, 3>> values_;
  std::vector<bool> directions_;
};

}  // namespace igsp::io
