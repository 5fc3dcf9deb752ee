#include <fmt/format.h>

#include <cstring>
#include <memory>

#include "io/number_text.hpp"
#include "io/pcd_compressed.hpp"
#include "io/pcd_header.hpp"
#include "io/rows.hpp"
#include "io/text_table.hpp"

namespace igsp::io {

namespace {

bool packs_colours(const PcdField& field) {
  return (field.name == "rgb" || field.name == "rgba") && field.size == 4 && field.count == 1;
}

/// The fields with the colours still packed, as the file has them.
struct Packed {
  std::vector<RowValue> values;
  std::vector<RowField> fields;
};

std::string unpacked_name(const std::string& name) {
  return name.starts_with("normal_") && name.size() == 8 ? fmt::format("n{}", name[7]) : name;
}

Packed packed_fields(const InputFile& file, const PcdHeader& header) {
  Packed packed;
  for (const PcdField& field : header.fields) {
    // The bits of a float that is no number would not survive as one.
    const ScalarType type = packs_colours(field) ? ScalarType::uint32 : scalar_type_of(file, field);
    for (std::uint64_t i = 0; i < field.count; ++i) {
      const bool padding = field.name == "_";
      packed.values.push_back({type, padding ? std::nullopt : std::optional(packed.fields.size()), {}});
      if (padding) continue;
      const std::string name = unpacked_name(field.name);
      packed.fields.push_back({field.count == 1 ? name : fmt::format("{}_{}", name, i), type});
    }
  }
  return packed;
}

/// Where ascii holds a float, it is the packed colour's bits.
double colour_in(const InputFile& file, std::string_view token, const PcdField& field) {
  if (field.type != 'F') return parse_number<std::uint32_t>(token).value_or(0);
  const auto value = parse_number<float>(token);
  if (!value) file.fail_at_line(in_quotes(token) + " is not a number (or too large or too small for one)");
  return std::bit_cast<std::uint32_t>(*value);
}

std::function<bool(std::span<double>)> line_rows(InputFile& file, const PcdHeader& header, const Packed& packed) {
  TextTable table;
  table.remaining = header.points;
  std::vector<PcdField> field_of_value;
  for (const PcdField& field : header.fields) {
    if (table.columns.size() + field.count > InputFile::buffer_size) file.fail_at_line("too many values for one point");
    table.columns.insert(table.columns.end(), field.count, coordinate_named(field.name));
    field_of_value.insert(field_of_value.end(), field.count, field);
  }
  table.require_records(file);
  return [&file, table, values = packed.values, field_of_value](std::span<double> row) mutable {
    std::string_view line;
    if (!table.next_line(file, line)) return false;
    parse_point(file, line, table);  // fails where it is none
    Tokenizer tokens(line, ' ');
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::string_view token;
      tokens.next(token);
      if (!values[i].field) continue;
      if (packs_colours(field_of_value[i])) {
        row[*values[i].field] = colour_in(file, token, field_of_value[i]);
        continue;
      }
      const auto number = parse_number<double>(token);
      if (!number) file.fail_at_line(in_quotes(token) + " is not a number (or too large or too small for one)");
      row[*values[i].field] = checked_value(file, *number, values[i].type);
    }
    return true;
  };
}

std::function<bool(std::span<double>)> compressed_rows(InputFile& file, const PcdHeader& header, const Packed& packed) {
  if (header.points == 0) return [](std::span<double>) { return false; };
  const auto bytes = std::make_shared<std::vector<char>>(read_pcd_compressed(file, header));
  std::vector<std::uint64_t> offsets;  // of the first point's; a field of several values has them side by side
  std::vector<std::uint64_t> steps;
  std::uint64_t offset = 0;
  for (const PcdField& field : header.fields) {
    for (std::uint64_t i = 0; i < field.count; ++i) {
      offsets.push_back(offset + i * field.size);
      steps.push_back(field.size * field.count);
    }
    offset += field.size * field.count * header.points;
  }
  return [&file, bytes, values = packed.values, offsets, steps, count = header.points,
          point = std::uint64_t{0}](std::span<double> row) mutable {
    if (point == count) return false;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!values[i].field) continue;
      const char* value = bytes->data() + offsets[i] + point * steps[i];
      row[*values[i].field] =
          checked_value(file, decoder_of(values[i].type, std::endian::little)(value), values[i].type);
    }
    ++point;
    return true;
  };
}

/// The rows with red, green, blue (and alpha) in place of the number that packs them.
RowSource unpacked(RowSource rows, std::size_t packed, bool alpha) {
  const std::size_t width = rows.fields.size();
  std::vector<RowField> colours = {
      {"red", ScalarType::uint8}, {"green", ScalarType::uint8}, {"blue", ScalarType::uint8}};
  if (alpha) colours.push_back({"alpha", ScalarType::uint8});
  RowSource result = rows;
  result.fields.erase(result.fields.begin() + static_cast<std::ptrdiff_t>(packed));
  result.fields.insert(result.fields.begin() + static_cast<std::ptrdiff_t>(packed), colours.begin(), colours.end());
  for (std::size_t& axis : result.coordinates) axis += axis > packed ? colours.size() - 1 : 0;
  result.next = [next = std::move(rows.next), packed, count = colours.size(),
                 before = std::vector<double>(width)](std::span<double> row) mutable {
    if (!next(before)) return false;
    std::ranges::copy(before.begin(), before.begin() + static_cast<std::ptrdiff_t>(packed), row.begin());
    const auto bits = static_cast<std::uint32_t>(before[packed]);
    for (std::size_t i = 0; i < count; ++i) row[packed + i] = bits >> (i < 3 ? 16 - 8 * i : 24) & 0xFF;
    std::ranges::copy(before.begin() + static_cast<std::ptrdiff_t>(packed) + 1, before.end(),
                      row.begin() + static_cast<std::ptrdiff_t>(packed + count));
    return true;
  };
  return result;
}

}  // namespace

RowSource open_pcd_rows(InputFile& file) {
  const PcdHeader header = read_pcd_header(file);
  const Packed packed = packed_fields(file, header);
  RowSource rows;
  rows.fields = packed.fields;
  rows.viewpoint = header.viewpoint;
  for (std::size_t i = 0; i < rows.fields.size(); ++i) {
    const Column column = coordinate_named(rows.fields[i].name);
    if (column < Column::skip) rows.coordinates[static_cast<std::size_t>(column)] = i;
  }
  if (header.format == FileFormat::pcd_ascii) {
    rows.next = line_rows(file, header, packed);
  } else if (header.format == FileFormat::pcd_binary) {
    rows.next = binary_rows(file, packed.values, header.points, std::endian::little);
  } else {
    rows.next = compressed_rows(file, header, packed);
  }
  for (std::size_t i = rows.fields.size(); i-- > 0;) {
    const bool alpha = rows.fields[i].name == "rgba";  // before the rows are moved away
    const bool colours = rows.fields[i].type == ScalarType::uint32 && (alpha || rows.fields[i].name == "rgb");
    if (colours) rows = unpacked(std::move(rows), i, alpha);
  }
  return rows;
}

}  // namespace igsp::io
