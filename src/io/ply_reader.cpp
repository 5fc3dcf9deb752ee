#include <fmt/format.h>

#include <algorithm>

#include "io/ply_header.hpp"
#include "io/point_body.hpp"

namespace igsp::io {

namespace {

Column column_of(const PlyProperty& property) {
  if (property.list_length) return Column::list;
  return coordinate_named(property.name);
}

bool has_list(const PlyElement& element) {
  return std::ranges::any_of(element.properties, [](const PlyProperty& p) { return p.list_length.has_value(); });
}

ListRecords list_records(const PlyElement& element, FileFormat format) {
  ListRecords records{{}, byte_order_of(format), element.count};
  for (const PlyProperty& property : element.properties) {
    records.fields.push_back({column_of(property), property.type, property.list_length.value_or(ScalarType::uint8)});
  }
  return records;
}

FixedRecords fixed_records(const PlyElement& element, FileFormat format) {
  FixedRecords records;
  records.remaining = element.count;
  for (const PlyProperty& property : element.properties) {
    const Column column = column_of(property);
    if (column != Column::skip) {
      records.coordinates[static_cast<std::size_t>(column)] = {decoder_of(property.type, byte_order_of(format)),
                                                               records.stride, 0};
    }
    records.stride += size_of(property.type);
  }
  for (Coordinate& coordinate : records.coordinates) coordinate.step = records.stride;
  return records;
}

TextTable text_table(const PlyElement& element) {
  TextTable table;
  table.remaining = element.count;
  for (const PlyProperty& property : element.properties) table.columns.push_back(column_of(property));
  return table;
}

/// Passes over an element that lies before the vertices.
void skip_element(InputFile& file, const PlyElement& element, FileFormat format) {
  if (format != FileFormat::ply_ascii) return list_records(element, format).skip_all(file);
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (!file.skip_line()) {
      file.fail_at_line(
          fmt::format("the file ends after {} of {} '{}' elements: truncated", i, element.count, element.name));
    }
  }
}

}  // namespace

PointBody open_ply(InputFile& file) {
  const PlyHeader header = read_ply_header(file);
  const std::size_t index = find_vertex(file, header);
  for (std::size_t i = 0; i < index; ++i) skip_element(file, header.elements[i], header.format);

  const PlyElement& vertex = header.elements[index];
  PointBody body{header.format, vertex.count, header.viewpoint};
  if (header.format == FileFormat::ply_ascii) {
    const TextTable table = text_table(vertex);
    table.require_records(file);
    body.records = table;
  } else if (has_list(vertex)) {
    const ListRecords records = list_records(vertex, header.format);
    file.require_records(records.remaining, records.smallest_size(), "points");
    body.records = records;
  } else {
    const FixedRecords records = fixed_records(vertex, header.format);
    records.require_records(file);
    body.records = records;
  }
  return body;
}

}  // namespace igsp::io
