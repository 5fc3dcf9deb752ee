#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "io/chunk.hpp"
#include "io/input_file.hpp"
#include "io/scalar_type.hpp"
#include "io/text_table.hpp"

namespace igsp::io {

/// Where x, y or z lies: in record i at byte offset + i * step.
struct Coordinate {
  Decoder decode = nullptr;
  std::size_t offset = 0;
  std::size_t step = 0;
};

/// Points as records of one size: PCD binary and binary PLY whose vertex has no list.
struct FixedRecords {
  std::array<Coordinate, 3> coordinates;
  std::size_t stride = 0;
  std::uint64_t remaining = 0;

  void require_records(const InputFile& file) const;
  void fill(InputFile& file, Chunk& chunk);
};

/// One value of a record, or a list of values behind its length.
struct BinaryField {
  Column column = Column::skip;
  ScalarType type = ScalarType::float32;
  ScalarType list_length = ScalarType::uint8;  ///< only where column is a list
};

/// Points as records of varying size: binary PLY whose vertex has lists.
struct ListRecords {
  std::vector<BinaryField> fields;
  std::endian byte_order = std::endian::little;
  std::uint64_t remaining = 0;

  /// The size of a record whose lists are empty.
  std::size_t smallest_size() const;
  void fill(InputFile& file, Chunk& chunk);
  /// Passes over all records without looking at points.
  void skip_all(InputFile& file) const;
};

/// Points as one block of memory with all x, then all y, then all z: PCD binary_compressed.
struct ColumnRecords {
  std::vector<char> bytes;
  std::array<Coordinate, 3> coordinates;
  std::uint64_t position = 0;
  std::uint64_t count = 0;

  void fill(InputFile&, Chunk& chunk);  ///< needs no more of the file; the signature is that of the others
};

/// The bytes of a list's values, after its length, `written`, has been read; fails for a length that is none, negative
/// or 2^32 and more.
std::uint64_t list_bytes(const InputFile& file, std::string_view written, ScalarType length, ScalarType value,
                         std::endian byte_order);

}  // namespace igsp::io
