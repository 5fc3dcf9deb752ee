#include "io/binary_records.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace igsp::io {

namespace {

using PointCoordinates = std::array<double, 3>;

double decode(const Coordinate& coordinate, const char* bytes, std::uint64_t record) {
  return coordinate.decode(bytes + coordinate.offset + record * coordinate.step);
}

void add_records(const std::array<Coordinate, 3>& xyz, const char* bytes, std::uint64_t first, std::uint64_t count,
                 Chunk& chunk) {
  for (std::uint64_t i = first; i < first + count; ++i) {
    chunk.add(decode(xyz[0], bytes, i), decode(xyz[1], bytes, i), decode(xyz[2], bytes, i));
  }
}

void skip_list(InputFile& file, const BinaryField& field, std::endian byte_order) {
  const std::string_view written = file.read(size_of(field.list_length));
  file.skip(list_bytes(file, written, field.list_length, field.type, byte_order));
}

/// Passes one record; its coordinates where it has them.
PointCoordinates read_record(InputFile& file, const ListRecords& records) {
  PointCoordinates point{};
  for (const BinaryField& field : records.fields) {
    if (field.column == Column::list) {
      skip_list(file, field, records.byte_order);
    } else if (field.column == Column::skip) {
      file.skip(size_of(field.type));
    } else {
      const char* bytes = file.read(size_of(field.type)).data();
      point[static_cast<std::size_t>(field.column)] = decoder_of(field.type, records.byte_order)(bytes);
    }
  }
  return point;
}

}  // namespace

std::uint64_t list_bytes(const InputFile& file, std::string_view written, ScalarType length, ScalarType value,
                         std::endian byte_order) {
  constexpr double too_long = 0x1p32;  // whose bytes cannot be counted
  const double count = decoder_of(length, byte_order)(written.data());
  if (!(count >= 0 && count < too_long)) {
    file.fail_at_offset(file.offset() - written.size(), fmt::format("a list of {} values", count));
  }
  return static_cast<std::uint64_t>(count) * size_of(value);
}

void FixedRecords::require_records(const InputFile& file) const {
  file.require_records(remaining, stride, "points");
  if (stride > InputFile::buffer_size) {
    file.fail_at_offset(
        file.offset(), fmt::format("{} bytes for one point; at most {} are supported", stride, InputFile::buffer_size));
  }
}

void FixedRecords::fill(InputFile& file, Chunk& chunk) {
  const std::uint64_t block = InputFile::buffer_size / stride;
  while (!chunk.full() && remaining > 0) {
    const std::uint64_t count = std::min({block, remaining, std::uint64_t{chunk.limit - chunk.points.size()}});
    const std::string_view bytes = file.read(count * stride);
    add_records(coordinates, bytes.data(), 0, count, chunk);
    remaining -= count;
  }
}

std::size_t ListRecords::smallest_size() const {
  std::size_t size = 0;
  for (const BinaryField& field : fields) {
    size += size_of(field.column == Column::list ? field.list_length : field.type);
  }
  return size;
}

void ListRecords::fill(InputFile& file, Chunk& chunk) {
  for (; !chunk.full() && remaining > 0; --remaining) {
    const auto [x, y, z] = read_record(file, *this);
    chunk.add(x, y, z);
  }
}

void ListRecords::skip_all(InputFile& file) const {
  if (fields.empty()) return;
  file.require_records(remaining, smallest_size(), "records");
  const bool lists = std::ranges::any_of(fields, [](const BinaryField& f) { return f.column == Column::list; });
  if (!lists) return file.skip(remaining * smallest_size());
  for (std::uint64_t i = 0; i < remaining; ++i) read_record(file, *this);
}

void ColumnRecords::fill(InputFile&, Chunk& chunk) {
  while (!chunk.full() && position < count) {
    const std::uint64_t now = std::min(count - position, std::uint64_t{chunk.limit - chunk.points.size()});
    add_records(coordinates, bytes.data(), position, now, chunk);
    position += now;
  }
}

}  // namespace igsp::io
