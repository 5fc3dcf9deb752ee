#include <algorithm>

#include "io/pcd_compressed.hpp"
#include "io/pcd_header.hpp"
#include "io/point_body.hpp"

namespace igsp::io {

namespace {

Column column_of(const PcdField& field) {
  return coordinate_named(field.name);
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

ColumnRecords column_records(InputFile& file, const PcdHeader& header) {
  ColumnRecords records;
  if (header.points == 0) return records;
  records.bytes = read_pcd_compressed(file, header);
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
  PointBody body{header.format, header.points, header.viewpoint};
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
