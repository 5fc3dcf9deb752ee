#include <fmt/format.h>

#include "io/number_text.hpp"
#include "io/ply_header.hpp"
#include "io/rows.hpp"
#include "io/text_table.hpp"

namespace igsp::io {

namespace {

std::vector<RowValue> values_of(const PlyElement& element) {
  std::vector<RowValue> values;
  std::size_t fields = 0;
  for (const PlyProperty& property : element.properties) {
    const bool list = property.list_length.has_value();
    values.push_back({property.type, list ? std::nullopt : std::optional(fields++), property.list_length});
  }
  return values;
}

/// An element before the vertices.
void pass_over(InputFile& file, const PlyHeader& header, const PlyElement& element) {
  std::vector<RowValue> values = values_of(element);
  if (values.empty()) return;
  if (header.format == FileFormat::ply_ascii) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (file.skip_line()) continue;
      file.fail_at_line(
          fmt::format("the file ends after {} of {} '{}' elements: truncated", i, element.count, element.name));
    }
    return;
  }
  std::vector<double> row(values.size());
  const bool big = header.format == FileFormat::ply_binary_big_endian;
  const auto next = binary_rows(file, std::move(values), element.count, big ? std::endian::big : std::endian::little);
  while (next(row)) {
  }
}

std::function<bool(std::span<double>)> line_rows(InputFile& file, const PlyElement& vertex) {
  TextTable table;
  table.remaining = vertex.count;
  for (const PlyProperty& property : vertex.properties) {
    table.columns.push_back(property.list_length ? Column::list : coordinate_named(property.name));
  }
  table.require_records(file);
  return [&file, table, values = values_of(vertex)](std::span<double> row) mutable {
    std::string_view line;
    if (!table.next_line(file, line)) return false;
    parse_point(file, line, table);  // fails where it is none
    Tokenizer tokens(line, ' ');
    for (const RowValue& value : values) {
      std::string_view token;
      tokens.next(token);
      const auto number = parse_number<double>(token);
      if (!number) file.fail_at_line(in_quotes(token) + " is not a number (or too large or too small for one)");
      for (double i = 0; value.list_length && i < *number; ++i) tokens.next(token);
      if (value.field) row[*value.field] = checked_value(file, *number, value.type);
    }
    return true;
  };
}

}  // namespace

RowSource open_ply_rows(InputFile& file) {
  const PlyHeader header = read_ply_header(file);
  const std::size_t index = find_vertex(file, header);
  const PlyElement& vertex = header.elements[index];
  RowSource rows;
  rows.viewpoint = header.viewpoint;
  for (const PlyProperty& property : vertex.properties) {
    if (property.list_length) {
      rows.left_out.push_back(property.name);
      continue;
    }
    const Column column = coordinate_named(property.name);
    if (column < Column::skip) rows.coordinates[static_cast<std::size_t>(column)] = rows.fields.size();
    rows.fields.push_back({property.name, property.type});
  }
  for (std::size_t i = 0; i < header.elements.size(); ++i) {
    const PlyElement& element = header.elements[i];
    if (i != index && element.count > 0) rows.left_out.push_back(fmt::format("{} x {}", element.count, element.name));
    if (i < index) pass_over(file, header, element);
  }
  if (header.format == FileFormat::ply_ascii) {
    rows.next = line_rows(file, vertex);
  } else {
    const bool big = header.format == FileFormat::ply_binary_big_endian;
    rows.next = binary_rows(file, values_of(vertex), vertex.count, big ? std::endian::big : std::endian::little);
  }
  return rows;
}

}  // namespace igsp::io
