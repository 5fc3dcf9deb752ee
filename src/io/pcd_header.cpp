#include "io/pcd_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "io/header_lines.hpp"
#include "io/number_text.hpp"
#include "io/text_table.hpp"

namespace igsp::io {

namespace {

/// A header line: the values behind its keyword and where it stood.
struct Entry {
  std::vector<std::string> values;
  std::uint64_t line = 0;
};
using Entries = std::map<std::string, Entry, std::less<>>;

bool is_keyword(std::string_view word) {
  for (const auto known :
       {"VERSION", "FIELDS", "COLUMNS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"}) {
    if (word == known) return true;
  }
  return false;
}

/// All lines up to DATA, by keyword. COLUMNS is the old name of FIELDS.
Entries read_entries(InputFile& file) {
  Entries entries;
  while (!entries.contains("DATA")) {
    const auto words = split_words(read_header_line(file));
    if (words.empty() || words[0].starts_with('#')) continue;
    if (!is_keyword(words[0])) file.fail_at_line("not a PCD header line: " + in_quotes(words[0]));
    const std::string key(words[0] == "COLUMNS" ? "FIELDS" : words[0]);
    if (!entries.try_emplace(key, Entry{{words.begin() + 1, words.end()}, file.line()}).second) {
      file.fail_at_line("a second " + key + " line");
    }
  }
  return entries;
}

const Entry& require(const InputFile& file, const Entries& entries, std::string_view key) {
  const auto found = entries.find(key);
  if (found == entries.end()) file.fail_at_line(fmt::format("the header ends without a {} line", key));
  return found->second;
}

std::uint64_t parse_count(const InputFile& file, const Entry& entry, std::string_view value) {
  const auto number = parse_number<std::uint64_t>(value);
  if (!number) file.fail_at_line(entry.line, in_quotes(value) + " is not a count");
  return *number;
}

void require_one_per_field(const InputFile& file, const Entry& entry, std::size_t fields) {
  if (entry.values.size() != fields) {
    file.fail_at_line(entry.line,
                      fmt::format("{} values for {} fields: write one for each", entry.values.size(), fields));
  }
}

std::vector<PcdField> parse_fields(const InputFile& file, const Entries& entries) {
  std::vector<PcdField> fields;
  for (const std::string& name : require(file, entries, "FIELDS").values) fields.push_back({name});
  const Entry& sizes = require(file, entries, "SIZE");
  const Entry& types = require(file, entries, "TYPE");
  require_one_per_field(file, sizes, fields.size());
  require_one_per_field(file, types, fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    fields[i].size = parse_count(file, sizes, sizes.values[i]);
    if (types.values[i].size() != 1) file.fail_at_line(types.line, "unknown type " + in_quotes(types.values[i]));
    const char type = types.values[i][0];
    fields[i].type = type >= 'a' && type <= 'z' ? static_cast<char>(type - 'a' + 'A') : type;
  }
  if (const auto found = entries.find("COUNT"); found != entries.end()) {
    const Entry& counts = found->second;
    require_one_per_field(file, counts, fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) {
      fields[i].count = parse_count(file, counts, counts.values[i]);
      if (fields[i].count > InputFile::buffer_size) {
        file.fail_at_line(counts.line, fmt::format("COUNT {}; at most {} values of one field are supported",
                                                   fields[i].count, InputFile::buffer_size));
      }
    }
  }
  return fields;
}

std::optional<std::uint64_t> find_count(const InputFile& file, const Entries& entries, std::string_view key) {
  const auto found = entries.find(key);
  if (found == entries.end()) return std::nullopt;
  const Entry& entry = found->second;
  if (entry.values.size() != 1) file.fail_at_line(entry.line, fmt::format("expected '{} <count>'", key));
  return parse_count(file, entry, entry.values[0]);
}

/// POINTS and WIDTH x HEIGHT say the same; one of them is enough.
std::uint64_t parse_points(const InputFile& file, const Entries& entries) {
  const auto points = find_count(file, entries, "POINTS");
  const auto width = find_count(file, entries, "WIDTH");
  const std::uint64_t height = find_count(file, entries, "HEIGHT").value_or(1);
  if (!points && !width) file.fail_at_line("the header ends without POINTS and without WIDTH");
  if (!width) return *points;
  std::uint64_t product = 0;
  if (__builtin_mul_overflow(*width, height, &product) || (points && *points != product)) {
    file.fail_at_line(
        fmt::format("POINTS {} is not WIDTH {} x HEIGHT {}: correct the wrong one (WIDTH = POINTS, HEIGHT "
                    "= 1 for a cloud without rows)",
                    points ? fmt::to_string(*points) : "(missing)", *width, height));
  }
  return product;
}

FileFormat parse_data(const InputFile& file, const Entries& entries) {
  const Entry& data = require(file, entries, "DATA");
  if (data.values.size() == 1) {
    if (data.values[0] == "ascii") return FileFormat::pcd_ascii;
    if (data.values[0] == "binary") return FileFormat::pcd_binary;
    if (data.values[0] == "binary_compressed") return FileFormat::pcd_binary_compressed;
  }
  file.fail_at_line(data.line, "expected 'DATA ascii', 'DATA binary' or 'DATA binary_compressed'");
}

std::optional<Eigen::Vector3d> find_viewpoint(const Entries& entries) {
  const auto found = entries.find("VIEWPOINT");
  if (found == entries.end()) return std::nullopt;
  const std::vector<std::string_view> words(found->second.values.begin(), found->second.values.end());
  const auto pose = parse_pcd_pose(words);
  if (!pose || *pose == default_pcd_pose) return std::nullopt;
  return Eigen::Vector3d((*pose)[0], (*pose)[1], (*pose)[2]);
}

/// 0.7, .7 and older; what calls itself 1.0 or more is made by other rules.
void require_version(const InputFile& file, const Entries& entries) {
  const auto found = entries.find("VERSION");
  if (found == entries.end() || found->second.values.empty()) return;
  const auto version = parse_number<double>(found->second.values[0]);
  if (version && *version < 1.0) return;
  file.fail_at_line(found->second.line,
                    fmt::format("PCD version {} is not supported, 0.7 and older are: export the cloud "
                                "as PCD 0.7 or PLY",
                                in_quotes(found->second.values[0])));
}

void require_coordinates(const InputFile& file, const PcdHeader& header) {
  for (const Column wanted : {Column::x, Column::y, Column::z}) {
    const char name = "xyz"[static_cast<std::size_t>(wanted)];
    const auto is_wanted = [&](const PcdField& field) { return coordinate_named(field.name) == wanted; };
    const auto found = std::ranges::count_if(header.fields, is_wanted);
    if (found != 1) {
      std::vector<std::string_view> names;
      for (const PcdField& field : header.fields) names.push_back(field.name);
      file.fail_at_line(fmt::format("{} fields named '{}' in the header, expected one; it has {}", found, name,
                                    fmt::join(names, ", ")));
    }
    const auto count = std::ranges::find_if(header.fields, is_wanted)->count;
    if (count != 1) file.fail_at_line(fmt::format("field '{}' has COUNT {}, expected 1", name, count));
  }
}

}  // namespace

std::optional<PcdPose> parse_pcd_pose(std::span<const std::string_view> words) {
  PcdPose pose{};
  if (words.size() != pose.size()) return std::nullopt;
  for (std::size_t i = 0; i < pose.size(); ++i) {
    const auto value = parse_number<double>(words[i]);
    if (!value || !std::isfinite(*value)) return std::nullopt;
    pose[i] = *value;
  }
  return pose;
}

PcdHeader read_pcd_header(InputFile& file) {
  const Entries entries = read_entries(file);
  require_version(file, entries);
  PcdHeader header;
  header.format = parse_data(file, entries);
  header.fields = parse_fields(file, entries);
  header.points = parse_points(file, entries);
  header.viewpoint = find_viewpoint(entries);
  for (const PcdField& field : header.fields) scalar_type_of(file, field);
  require_coordinates(file, header);
  return header;
}

std::uint64_t PcdHeader::stride() const {
  std::uint64_t bytes = 0;
  for (const PcdField& field : fields) bytes += field.size * field.count;
  return bytes;
}

ScalarType scalar_type_of(const InputFile& file, const PcdField& field) {
  if (field.type == 'F' && field.size == 4) return ScalarType::float32;
  if (field.type == 'F' && field.size == 8) return ScalarType::float64;
  if (field.type == 'I' || field.type == 'U') {
    const bool is_signed = field.type == 'I';
    switch (field.size) {
      case 1:
        return is_signed ? ScalarType::int8 : ScalarType::uint8;
      case 2:
        return is_signed ? ScalarType::int16 : ScalarType::uint16;
      case 4:
        return is_signed ? ScalarType::int32 : ScalarType::uint32;
      case 8:
        return is_signed ? ScalarType::int64 : ScalarType::uint64;
      default:
        break;
    }
  }
  file.fail_at_line(fmt::format("unknown type: field {} has TYPE {} and SIZE {}", in_quotes(field.name),
                                in_quotes({&field.type, 1}), field.size));
}

}  // namespace igsp::io
