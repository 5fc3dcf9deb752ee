#include "io/las_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace igsp::io {

namespace {

using enum ScalarType;

// Offsets: tables 7 to 18 of the LAS 1.4 specification (ASPRS).

std::vector<LasField> fields_before_6() {
  return {{"intensity", uint16, 12},
          {"return_number", uint8, 14, 0, 3},
          {"number_of_returns", uint8, 14, 3, 3},
          {"scan_direction_flag", uint8, 14, 6, 1},
          {"edge_of_flight_line", uint8, 14, 7, 1},
          {"classification", uint8, 15, 0, 5},
          {"synthetic", uint8, 15, 5, 1},
          {"key_point", uint8, 15, 6, 1},
          {"withheld", uint8, 15, 7, 1},
          {"scan_angle_rank", int8, 16},
          {"user_data", uint8, 17},
          {"point_source_id", uint16, 18}};
}

std::vector<LasField> fields_from_6() {
  return {{"intensity", uint16, 12},
          {"return_number", uint8, 14, 0, 4},
          {"number_of_returns", uint8, 14, 4, 4},
          {"synthetic", uint8, 15, 0, 1},
          {"key_point", uint8, 15, 1, 1},
          {"withheld", uint8, 15, 2, 1},
          {"overlap", uint8, 15, 3, 1},
          {"scanner_channel", uint8, 15, 4, 2},
          {"scan_direction_flag", uint8, 15, 6, 1},
          {"edge_of_flight_line", uint8, 15, 7, 1},
          {"classification", uint8, 16},
          {"user_data", uint8, 17},
          {"scan_angle", int16, 18},
          {"point_source_id", uint16, 20}};
}

void append(std::vector<LasField>& fields, std::size_t& offset, std::initializer_list<LasField> more) {
  for (LasField field : more) {
    field.offset = offset;
    offset += size_of(field.type);
    fields.push_back(field);
  }
}

std::vector<LasField> fields_of_format(int format) {
  const bool old = format < 6;
  std::vector<LasField> fields = old ? fields_before_6() : fields_from_6();
  std::size_t offset = old ? 20 : 22;
  const auto among = [&](std::initializer_list<int> formats) { return std::ranges::count(formats, format) > 0; };
  if (!among({0, 2})) append(fields, offset, {{"gps_time", float64}});
  if (among({2, 3, 5, 7, 8, 10})) append(fields, offset, {{"red", uint16}, {"green", uint16}, {"blue", uint16}});
  if (among({8, 10})) append(fields, offset, {{"nir", uint16}});
  if (among({4, 5, 9, 10})) {
    append(fields, offset,
           {{"wavepacket_index", uint8},
            {"wavepacket_offset", uint64},
            {"wavepacket_size", uint32},
            {"return_point_wave_location", float32},
            {"x_t", float32},
            {"y_t", float32},
            {"z_t", float32}});
  }
  return fields;
}

/// Table 24: 1 to 10 are single numbers, 11 to 30 two and three of them.
std::optional<ScalarType> extra_type(int data_type) {
  constexpr std::array types = {uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64};
  if (data_type < 1 || data_type > 30) return std::nullopt;
  return types[static_cast<std::size_t>((data_type - 1) % 10)];
}

/// Of 192 bytes: 2 reserved, the type, options (the size where there is no type), the name.
void append_described(std::vector<LasField>& fields, std::size_t& offset, std::string_view descriptor,
                      std::size_t record_length) {
  const int data_type = static_cast<unsigned char>(descriptor[2]);
  const auto type = extra_type(data_type);
  if (!type) {
    offset += data_type == 0 ? static_cast<unsigned char>(descriptor[3]) : record_length;
    return;
  }
  std::string name(descriptor.substr(4, 32));
  name.resize(std::min(name.find('\0'), name.size()));
  const int values = (data_type - 1) / 10 + 1;
  for (int i = 0; i < values; ++i) {
    if (offset + size_of(*type) > record_length) return;
    append(fields, offset, {{values > 1 ? fmt::format("{}_{}", name, i) : name, *type}});
  }
}

}  // namespace

double LasField::value(const char* record) const {
  if (bits == 0) return decoder_of(type, std::endian::little)(record + offset);
  return static_cast<unsigned char>(record[offset]) >> first_bit & ((1 << bits) - 1);
}

std::vector<LasField> las_fields(const LasHeader& header) {
  constexpr std::size_t descriptor = 192;
  std::vector<LasField> fields = fields_of_format(header.point_format);
  std::size_t offset = las_format_length(header.point_format);
  const std::string_view described = header.extra_bytes;
  for (std::size_t at = 0; at + descriptor <= described.size() && offset < header.record_length; at += descriptor) {
    append_described(fields, offset, described.substr(at, descriptor), header.record_length);
  }
  return fields;
}

std::size_t las_pulse_direction(int point_format) {
  for (const LasField& field : fields_of_format(point_format)) {
    if (field.name == "x_t") return field.offset;
  }
  return 0;
}

}  // namespace igsp::io
