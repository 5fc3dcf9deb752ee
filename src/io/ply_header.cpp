#include "io/ply_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "io/header_lines.hpp"
#include "io/number_text.hpp"
#include "io/text_table.hpp"

namespace igsp::io {

namespace {

using Words = std::vector<std::string_view>;

ScalarType parse_type(const InputFile& file, std::string_view name) {
  static constexpr std::pair<std::string_view, ScalarType> types[] = {
      {"char", ScalarType::int8},       {"int8", ScalarType::int8},       {"uchar", ScalarType::uint8},
      {"uint8", ScalarType::uint8},     {"short", ScalarType::int16},     {"int16", ScalarType::int16},
      {"ushort", ScalarType::uint16},   {"uint16", ScalarType::uint16},   {"int", ScalarType::int32},
      {"int32", ScalarType::int32},     {"uint", ScalarType::uint32},     {"uint32", ScalarType::uint32},
      {"float", ScalarType::float32},   {"float32", ScalarType::float32}, {"double", ScalarType::float64},
      {"float64", ScalarType::float64}, {"int64", ScalarType::int64},     {"uint64", ScalarType::uint64}};
  for (const auto& [known, type] : types) {
    if (name == known) return type;
  }
  file.fail_at_line("unknown property type " + in_quotes(name));
}

FileFormat parse_format(const InputFile& file, const Words& words) {
  static constexpr std::pair<std::string_view, FileFormat> formats[] = {
      {"ascii", FileFormat::ply_ascii},
      {"binary_little_endian", FileFormat::ply_binary_little_endian},
      {"binary_big_endian", FileFormat::ply_binary_big_endian}};
  if (words.size() == 3 && words[2] == "1.0") {
    for (const auto& [name, format] : formats) {
      if (words[1] == name) return format;
    }
  }
  file.fail_at_line("not a PLY format: expected ascii, binary_little_endian or binary_big_endian and 1.0");
}

PlyElement parse_element(const InputFile& file, const Words& words) {
  const auto count = words.size() == 3 ? parse_number<std::uint64_t>(words[2]) : std::nullopt;
  if (!count) file.fail_at_line("expected 'element <name> <count>'");
  return {std::string(words[1]), *count, {}};
}

PlyProperty parse_property(const InputFile& file, const Words& words) {
  if (words.size() == 3) return {std::string(words[2]), parse_type(file, words[1]), std::nullopt};
  if (words.size() != 5 || words[1] != "list") {
    file.fail_at_line("expected 'property <type> <name>' or 'property list <type> <type> <name>'");
  }
  const ScalarType length = parse_type(file, words[2]);
  if (length == ScalarType::float32 || length == ScalarType::float64) {
    file.fail_at_line("the length of a list must have an integer type, not " + in_quotes(words[2]));
  }
  return {std::string(words[4]), parse_type(file, words[3]), length};
}

}  // namespace

std::optional<Eigen::Vector3d> ply_viewpoint(const std::vector<std::string_view>& words) {
  if (words.size() != 5 || words[0] != "comment" || words[1] != "viewpoint") return std::nullopt;
  Eigen::Vector3d viewpoint;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = parse_number<double>(words[i + 2]);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    viewpoint[static_cast<Eigen::Index>(i)] = *number;
  }
  return viewpoint;
}

std::string ply_viewpoint_comment(const Eigen::Vector3d& viewpoint) {
  return fmt::format("comment viewpoint {}", fmt::join(viewpoint.begin(), viewpoint.end(), " "));
}

std::endian byte_order_of(FileFormat format) {
  return format == FileFormat::ply_binary_big_endian ? std::endian::big : std::endian::little;
}

PlyHeader read_ply_header(InputFile& file) {
  PlyHeader header;
  bool format_known = false;
  if (split_words(read_header_line(file)) != Words{"ply"}) file.fail_at_offset(0, "not a PLY file: no 'ply' line");
  while (true) {
    const Words words = split_words(read_header_line(file));
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
      if (const auto viewpoint = ply_viewpoint(words)) header.viewpoint = viewpoint;
      continue;
    }
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      header.format = parse_format(file, words);
      format_known = true;
    } else if (words[0] == "element") {
      header.elements.push_back(parse_element(file, words));
    } else if (words[0] == "property") {
      if (header.elements.empty()) file.fail_at_line("a property before any element");
      header.elements.back().properties.push_back(parse_property(file, words));
    } else {
      file.fail_at_line("unknown header line " + in_quotes(words[0]));
    }
  }
  if (!format_known) file.fail_at_line("the header ends without a 'format' line");
  return header;
}

std::size_t find_vertex(const InputFile& file, const PlyHeader& header) {
  const auto is_vertex = [](const PlyElement& element) { return element.name == "vertex"; };
  const auto vertices = std::ranges::count_if(header.elements, is_vertex);
  if (vertices == 0) file.fail_at_line("no 'vertex' element in the header: a PLY file without points");
  if (vertices > 1) {
    file.fail_at_line(fmt::format(
        "{} 'vertex' elements in the header, expected one: save every scan in a file of its own", vertices));
  }
  const auto vertex = std::ranges::find_if(header.elements, is_vertex);
  for (const Column wanted : {Column::x, Column::y, Column::z}) {
    const auto found = std::ranges::count_if(
        vertex->properties, [&](const PlyProperty& p) { return !p.list_length && coordinate_named(p.name) == wanted; });
    if (found != 1) {
      std::vector<std::string_view> names;
      for (const PlyProperty& property : vertex->properties) names.push_back(property.name);
      file.fail_at_line(fmt::format("{} vertex properties named '{}' in the header, expected one; it has {}", found,
                                    "xyz"[static_cast<std::size_t>(wanted)], fmt::join(names, ", ")));
    }
  }
  return static_cast<std::size_t>(vertex - header.elements.begin());
}

}  // namespace igsp::io
