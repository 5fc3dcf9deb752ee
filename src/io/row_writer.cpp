#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/report_progress.hpp"
#include "igsp/errors.hpp"
#include "io/file_format.hpp"
#include "io/number_text.hpp"
#include "io/pcd_compressed.hpp"
#include "io/ply_header.hpp"
#include "io/rows.hpp"

namespace igsp::io {

namespace {

/// A value of the output: one field as it is, or colours packed into one number.
struct OutputValue {
  std::string name;
  ScalarType type = ScalarType::float64;
  std::vector<std::size_t> fields;  ///< red, green, blue (and alpha) where they are packed
  bool coordinate = false;
};

constexpr std::size_t block_size = std::size_t{1} << 18;

/// A word, unlike any before: PLY and PCD know no blanks in names.
std::string word_of(const std::string& name, const std::vector<OutputValue>& before) {
  std::string word = name.substr(0, name.find_first_of("[("));
  while (!word.empty() && word.back() == ' ') word.pop_back();
  for (char& c : word) {
    if (c <= ' ' || c == ',' || c == ';' || c == '"') c = '_';
  }
  if (word.empty()) word = "column";
  const auto taken = [&](const std::string& candidate) {
    return std::ranges::any_of(before, [&](const OutputValue& value) { return value.name == candidate; });
  };
  std::string unique = word;
  for (int i = 2; taken(unique); ++i) unique = fmt::format("{}_{}", word, i);
  return unique;
}

std::optional<std::size_t> find_field(const RowSource& rows, std::string_view name, ScalarType type) {
  for (std::size_t i = 0; i < rows.fields.size(); ++i) {
    if (rows.fields[i].type == type && rows.fields[i].name == name) return i;
  }
  return std::nullopt;
}

/// red, green and blue as bytes, and alpha where there is one; none otherwise.
std::vector<std::size_t> colours_of(const RowSource& rows) {
  std::vector<std::size_t> colours;
  for (const std::string_view name : {"red", "green", "blue", "alpha"}) {
    if (const auto field = find_field(rows, name, ScalarType::uint8)) colours.push_back(*field);
    if (name == "blue" && colours.size() != 3) return {};
  }
  return colours;
}

std::vector<OutputValue> values_of(const RowSource& rows, FormatFamily family) {
  const bool pcd = family == FormatFamily::pcd;
  const std::vector<std::size_t> colours = pcd ? colours_of(rows) : std::vector<std::size_t>{};
  std::vector<OutputValue> values;
  for (std::size_t i = 0; i < rows.fields.size(); ++i) {
    const RowField& field = rows.fields[i];
    const auto axis = std::ranges::find(rows.coordinates, i);
    if (std::ranges::find(colours, i) != colours.end()) {
      if (i != *std::ranges::min_element(colours)) continue;
      const bool alpha = colours.size() == 4;  // a float's bits with an alpha may be no number
      values.push_back({alpha ? "rgba" : "rgb", alpha ? ScalarType::uint32 : ScalarType::float32, colours, false});
      continue;
    }
    std::string name = word_of(field.name, values);
    if (axis != rows.coordinates.end()) name = std::string(1, "xyz"[axis - rows.coordinates.begin()]);
    const bool normal = name == "nx" || name == "ny" || name == "nz";
    if (pcd && normal) name = fmt::format("normal_{}", name[1]);
    const bool wide = field.type == ScalarType::int64 || field.type == ScalarType::uint64;
    values.push_back({name,
                      wide && family == FormatFamily::ply ? ScalarType::float64 : field.type,
                      {i},
                      axis != rows.coordinates.end()});
  }
  return values;
}

/// What is written for a value of a row.
double value_in(std::span<const double> row, const OutputValue& value) {
  if (value.fields.size() == 1) return row[value.fields[0]];
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < value.fields.size(); ++i) {
    bits |= static_cast<std::uint32_t>(row[value.fields[i]]) << (i < 3 ? 16 - 8 * i : 24);
  }
  return value.type == ScalarType::float32 ? std::bit_cast<float>(bits) : static_cast<double>(bits);
}

void append_text(std::string& text, double value, const OutputValue& output) {
  if (output.type == ScalarType::float64 || output.coordinate) {
    append_number(text, value);  // the digits of a float as a double: the same coordinate in every format
  } else if (output.type == ScalarType::float32) {
    append_number(text, static_cast<float>(value));
  } else {
    text += fmt::format("{:.0f}", value);
  }
}

std::string_view ply_name(ScalarType type) {
  switch (type) {
    case ScalarType::int8:
      return "char";
    case ScalarType::uint8:
      return "uchar";
    case ScalarType::int16:
      return "short";
    case ScalarType::uint16:
      return "ushort";
    case ScalarType::int32:
      return "int";
    case ScalarType::uint32:
      return "uint";
    case ScalarType::float32:
      return "float";
    default:
      return "double";
  }
}

char pcd_type(ScalarType type) {
  switch (type) {
    case ScalarType::float32:
    case ScalarType::float64:
      return 'F';
    case ScalarType::int8:
    case ScalarType::int16:
    case ScalarType::int32:
    case ScalarType::int64:
      return 'I';
    default:
      return 'U';
  }
}

std::string ply_header(const RowSource& rows, const std::vector<OutputValue>& values, const RowOutput& output) {
  std::string text = "ply\nformat ";
  text += output.format == FileFormat::ply_ascii               ? "ascii"
          : output.format == FileFormat::ply_binary_big_endian ? "binary_big_endian"
                                                               : "binary_little_endian";
  text += " 1.0\n";
  if (rows.viewpoint) text += ply_viewpoint_comment(*rows.viewpoint) + "\n";
  text += fmt::format("element vertex {}\n", output.count);
  for (const OutputValue& value : values) text += fmt::format("property {} {}\n", ply_name(value.type), value.name);
  return text + "end_header\n";
}

std::string pcd_header(const RowSource& rows, const std::vector<OutputValue>& values, const RowOutput& output) {
  std::string names, sizes, types, counts;
  for (const OutputValue& value : values) {
    names += " " + value.name;
    sizes += fmt::format(" {}", size_of(value.type));
    types += fmt::format(" {}", pcd_type(value.type));
    counts += " 1";
  }
  const Eigen::Vector3d position = rows.viewpoint.value_or(Eigen::Vector3d::Zero());
  const char* data = output.format == FileFormat::pcd_ascii    ? "ascii"
                     : output.format == FileFormat::pcd_binary ? "binary"
                                                               : "binary_compressed";
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS{}\nSIZE{}\nTYPE{}\nCOUNT{}\nWIDTH {}\nHEIGHT 1\n"
      "VIEWPOINT {} 1 0 0 0\nPOINTS {}\nDATA {}\n",
      names, sizes, types, counts, output.count, fmt::join(position.begin(), position.end(), " "), output.count, data);
}

/// CSV names its columns, PTS counts its points, other text names columns in a comment where there are more than three.
std::string text_header(const std::vector<OutputValue>& values, const RowOutput& output) {
  std::vector<std::string> names;
  for (const OutputValue& value : values) names.push_back(value.name);
  if (output.extension == ".csv") return fmt::format("{}\n", fmt::join(names, ","));
  if (output.extension == ".pts") return fmt::format("{}\n", output.count);
  if (output.count == 0) return "# 0 points\n";
  return names.size() > 3 ? fmt::format("# {}\n", fmt::join(names, " ")) : "";
}

/// Rows become bytes: in `body`, but for PCD binary_compressed a block a value.
class RowEncoder {
 public:
  RowEncoder(std::vector<OutputValue> values, const RowOutput& output) : values_(std::move(values)) {
    ascii_ = output.format == FileFormat::ply_ascii || output.format == FileFormat::pcd_ascii ||
             output.format == FileFormat::text;
    columns_ = output.format == FileFormat::pcd_binary_compressed;
    separator_ = output.extension == ".csv" ? ',' : ' ';
    const bool big = output.format == FileFormat::ply_binary_big_endian;
    for (const OutputValue& value : values_) {
      encoders_.push_back(encoder_of(value.type, big ? std::endian::big : std::endian::little));
    }
    blocks_.resize(columns_ ? values_.size() : 1);
  }

  void append(std::span<const double> row) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const double value = value_in(row, values_[i]);
      std::string& block = blocks_[columns_ ? i : 0];
      if (ascii_) {
        append_text(block, value, values_[i]);
        block += i + 1 < values_.size() ? separator_ : '\n';
        continue;
      }
      const std::size_t end = block.size();
      block.resize(end + size_of(values_[i].type));
      encoders_[i](block.data() + end, value);
    }
  }

  bool full() const { return !columns_ && blocks_[0].size() >= block_size; }

  std::string take() {
    if (!columns_) return std::exchange(blocks_[0], {});
    std::string body;
    for (std::string& block : blocks_) body += std::exchange(block, {});
    return compressed_pcd(body);
  }

 private:
  std::vector<OutputValue> values_;
  std::vector<Encoder> encoders_;
  std::vector<std::string> blocks_;
  bool ascii_ = false, columns_ = false;
  char separator_ = ' ';
};

}  // namespace

void write_rows(AtomicFile& file, RowSource& rows, const RowOutput& output) {
  const FormatFamily family = family_of(output.format);
  const std::vector<OutputValue> values = values_of(rows, family);
  file.write(family == FormatFamily::ply   ? ply_header(rows, values, output)
             : family == FormatFamily::pcd ? pcd_header(rows, values, output)
                                           : text_header(values, output));
  RowEncoder encoder(values, output);
  std::vector<double> row(rows.fields.size());
  std::uint64_t written = 0;
  while (rows.next(row)) {
    if (!std::ranges::all_of(rows.coordinates, [&](std::size_t axis) { return std::isfinite(row[axis]); })) continue;
    encoder.append(row);
    ++written;
    if (!encoder.full()) continue;
    file.write(encoder.take());
    report_progress(output.progress, "write", written, output.count);
  }
  file.write(encoder.take());
  if (written != output.count) {
    throw FileError(
        fmt::format("{} points came where {} were counted: the file changed while it was read", written, output.count));
  }
}

}  // namespace igsp::io
