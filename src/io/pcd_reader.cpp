#include <fmt/format.h>
#include <fmt/ranges.h>
#include <lzf.h>

#include <algorithm>
#include <cstring>
#include <ranges>

#include "io/pcd_header.hpp"
#include "io/point_body.hpp"

namespace igsp::io {

namespace {

Column column_of(const PcdField& field) {
  return coordinate_named(field.name);
}

void require_coordinates(const InputFile& file, const PcdHeader& header) {
  for (const Column wanted : {Column::x, Column::y, Column::z}) {
    const char name = "xyz"[static_cast<std::size_t>(wanted)];
    const auto is_wanted = [&](const PcdField& field) { return column_of(field) == wanted; };
    const auto found = std::ranges::count_if(header.fields, is_wanted);
    if (found != 1) {
      file.fail_at_line(fmt::format("{} fields named '{}' in the header, expected one; it has {}", found, name,
                                    fmt::join(header.fields | std::views::transform(&PcdField::name), ", ")));
    }
    const auto count = std::ranges::find_if(header.fields, is_wanted)->count;
    if (count != 1) file.fail_at_line(fmt::format("field '{}' has COUNT {}, expected 1", name, count));
  }
}

TextTable text_table(const InputFile& file, const PcdHeader& header) {
  TextTable table;
  table.remaining = header.points;
  for (const PcdField& field : header.fields) {
    if (table.columns.size() + field.count > InputFile::buffer_size) file.fail_at_line("too many values for one point");
    table.columns.insert(table.columns.end(), field.count, column_of(field));
  }
  table.require_records(file);
  return table;
}

FixedRecords fixed_records(const InputFile& file, const PcdHeader& header) {
  FixedRecords records;
  records.remaining = header.points;
  for (const PcdField& field : header.fields) {
    const Column column = column_of(field);
    if (column != Column::skip) {
      records.coordinates[static_cast<std::size_t>(column)] = {
          decoder_of(scalar_type_of(file, field), std::endian::little), records.stride, 0};
    }
    records.stride += field.size * field.count;
  }
  for (Coordinate& coordinate : records.coordinates) coordinate.step = records.stride;
  return records;
}

std::uint32_t read_uint32(InputFile& file) {
  return static_cast<std::uint32_t>(decoder_of(ScalarType::uint32, std::endian::little)(file.read(4).data()));
}

/// The body as one block: LZF has no way to decompress a part of it.
std::vector<char> read_compressed(InputFile& file, std::uint64_t points, std::uint64_t stride) {
  constexpr std::uint64_t best_ratio = 88;  // of LZF: 3 bytes stand for at most 264
  const std::uint64_t start = file.offset();
  const std::uint64_t compressed_size = read_uint32(file);
  const std::uint64_t size = read_uint32(file);
  file.require_records(1, compressed_size, "compressed bodies");
  if (size / stride != points || size % stride != 0) {
    file.fail_at_offset(start + 4,
                        fmt::format("a body of {} bytes cannot be {} points of {} bytes", size, points, stride));
  }
  if (size > best_ratio * compressed_size) {
    file.fail_at_offset(start, fmt::format("{} compressed bytes cannot hold {} bytes", compressed_size, size));
  }
  std::vector<char> compressed(compressed_size);
  for (std::size_t done = 0; done < compressed.size();) {
    const std::string_view part = file.read(std::min(InputFile::buffer_size, compressed.size() - done));
    std::memcpy(compressed.data() + done, part.data(), part.size());
    done += part.size();
  }
  std::vector<char> bytes(size);
  const unsigned decompressed = lzf_decompress(compressed.data(), static_cast<unsigned>(compressed_size), bytes.data(),
                                               static_cast<unsigned>(size));
  if (decompressed != size) file.fail_at_offset(start + 8, "the compressed body is damaged");
  return bytes;
}

ColumnRecords column_records(InputFile& file, const PcdHeader& header) {
  const std::uint64_t stride = fixed_records(file, header).stride;
  ColumnRecords records;
  if (header.points == 0) return records;
  records.bytes = read_compressed(file, header.points, stride);
  records.count = header.points;
  std::uint64_t offset = 0;
  for (const PcdField& field : header.fields) {
    const Column column = column_of(field);
    if (column != Column::skip) {
      records.coordinates[static_cast<std::size_t>(column)] = {
          decoder_of(scalar_type_of(file, field), std::endian::little), offset, field.size};
    }
    offset += field.size * field.count * header.points;
  }
  return records;
}

}  // namespace

PointBody open_pcd(InputFile& file) {
  const PcdHeader header = read_pcd_header(file);
  require_coordinates(file, header);
  PointBody body{header.format, header.points, {}};
  if (header.format == FileFormat::pcd_ascii) {
    body.records = text_table(file, header);
  } else if (header.format == FileFormat::pcd_binary) {
    const FixedRecords records = fixed_records(file, header);
    records.require_records(file);
    body.records = records;
  } else {
    body.records = column_records(file, header);
  }
  return body;
}

}  // namespace igsp::io
