#include "io/las_header.hpp"

#include <fmt/format.h>

#include <fstream>

namespace igsp::io {

namespace {

// Offsets and sizes of the LAS 1.4 specification (ASPRS), tables 3, 6 and 7 to 18.
constexpr std::size_t smallest_header = 227;
constexpr std::size_t minor_at = 25, header_size_at = 94, points_start_at = 96, records_at = 100, format_at = 104,
                      record_length_at = 105, old_count_at = 107, extended_at = 235, extended_count_at = 243,
                      count_at = 247;
constexpr std::size_t record_head = 54, extended_head = 60;  // of variable length records
constexpr std::size_t flags_at = 15, class_at = 16;          // in a point; before format 6 both are in one byte
constexpr std::array<std::size_t, 11> format_lengths = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr char compressed_bit = '\x80';

std::size_t header_size_of(int minor) {
  if (minor < 3) return smallest_header;
  return minor == 3 ? 235 : 375;
}

Eigen::Vector3d three_numbers(const std::string& bytes, std::size_t at) {
  return {las_number<double>(&bytes[at]), las_number<double>(&bytes[at + 8]), las_number<double>(&bytes[at + 16])};
}

std::string read_header_bytes(InputFile& file) {
  const std::string_view start = file.peek(smallest_header);
  if (!start.starts_with("LASF")) file.fail_at_offset(0, "not a LAS file: it does not begin with LASF");
  if (start.size() < smallest_header) file.fail_at_offset(start.size(), "the file ends within its header");
  if (start[format_at] & compressed_bit) {
    file.fail("compressed LAS (LAZ): use the Python package, pip install 'igsp[las]'");
  }
  const std::size_t size = las_number<std::uint16_t>(&start[header_size_at]);
  const int minor = static_cast<unsigned char>(start[minor_at]);
  if (size < header_size_of(minor)) {
    file.fail_at_offset(header_size_at,
                        fmt::format("a header of {} bytes; LAS 1.{} has {}", size, minor, header_size_of(minor)));
  }
  return std::string(file.read(size));
}

/// Goes through the records between header and points.
void read_records(InputFile& file, std::uint32_t count, LasHeader& header) {
  const auto room = [&] { return header.points_start - file.offset(); };
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t start = file.offset();
    const std::string head(room() < record_head ? std::string_view() : file.read(record_head));
    const std::uint64_t length = head.empty() ? 0 : las_number<std::uint16_t>(&head[20]);
    if (head.empty() || length > room()) {
      file.fail_at_offset(header.points_start,
                          fmt::format("the points begin before variable length record {}, at byte {}, ends", i, start));
    }
    const bool describes_extra_bytes = std::string_view(head).substr(2, 10) == std::string_view("LASF_Spec\0", 10) &&
                                       las_number<std::uint16_t>(&head[18]) == 4;
    if (describes_extra_bytes) {
      header.extra_bytes = file.read(length);
    } else {
      file.skip(length);
    }
  }
  file.skip(room());
}

/// Those behind the points, as far as LAS 1.4 has them: nothing is needed of them, but a file cut short is told.
void check_extended_records(const InputFile& file, std::uint64_t start, std::uint32_t count) {
  if (count == 0) return;
  InputFile again(file.path());
  const auto fail = [&](std::uint32_t i) {
    again.fail_at_offset(again.size(), fmt::format("the file ends before extended variable length record {}", i));
  };
  if (start > again.size()) fail(0);
  again.skip(start);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (again.remaining() < extended_head) fail(i);
    const std::uint64_t length = las_number<std::uint64_t>(again.read(extended_head).data() + 20);
    if (length > again.remaining()) fail(i);
    again.skip(length);
  }
}

void check_points(const InputFile& file, const LasHeader& header) {
  const bool usable = (header.scale.array() > 0).all() && (header.scale.array() < las_largest).all() &&
                      (header.offset.array().abs() < las_largest).all();
  if (!usable) {
    file.fail_at_offset(las_scale_begin, fmt::format("scale {} {} {}, offset {} {} {}: no coordinates can be made of "
                                                     "these",
                                                     header.scale.x(), header.scale.y(), header.scale.z(),
                                                     header.offset.x(), header.offset.y(), header.offset.z()));
  }
  if (header.record_length < las_format_length(header.point_format)) {
    file.fail_at_offset(record_length_at,
                        fmt::format("points of {} bytes; point format {} has at least {}", header.record_length,
                                    header.point_format, las_format_length(header.point_format)));
  }
  file.require_records(header.count, header.record_length, "points");
}

}  // namespace

std::size_t las_format_length(int point_format) {
  return format_lengths[static_cast<std::size_t>(point_format)];
}

Eigen::Vector3d LasHeader::local_position(const char* record) const {
  const Eigen::Vector3d stored(las_number<std::int32_t>(record), las_number<std::int32_t>(record + 4),
                               las_number<std::int32_t>(record + 8));
  return stored.cwiseProduct(scale);
}

Eigen::Vector3d LasHeader::position(const char* record) const {
  return local_position(record) + offset;
}

bool LasHeader::is_noise(const char* record) const {
  constexpr int low_noise = 7, high_noise = 18;
  const int flags = static_cast<unsigned char>(record[flags_at]);
  const bool old = point_format < 6;
  const int kind = old ? flags & 0x1F : static_cast<unsigned char>(record[class_at]);
  const int withheld = old ? flags & 0x80 : flags & 0x04;
  return kind == low_noise || kind == high_noise || withheld != 0;
}

LasHeader read_las_header(InputFile& file) {
  const std::string bytes = read_header_bytes(file);
  LasHeader header;
  header.points_start = las_number<std::uint32_t>(&bytes[points_start_at]);
  header.point_format = bytes[format_at] & 0x3F;
  header.record_length = las_number<std::uint16_t>(&bytes[record_length_at]);
  header.count = las_number<std::uint32_t>(&bytes[old_count_at]);
  header.scale = three_numbers(bytes, las_scale_begin);
  header.offset = three_numbers(bytes, las_scale_begin + 24);
  if (header.point_format >= static_cast<int>(format_lengths.size())) {
    file.fail_at_offset(format_at, fmt::format("point format {}; LAS has 0 to 10", header.point_format));
  }
  if (header.points_start < bytes.size() || header.points_start > file.size()) {
    file.fail_at_offset(points_start_at, fmt::format("the points begin at byte {}; the header ends at {} and the file "
                                                     "at {}",
                                                     header.points_start, bytes.size(), file.size()));
  }
  if (static_cast<unsigned char>(bytes[minor_at]) >= 4) {
    header.count = las_number<std::uint64_t>(&bytes[count_at]);
    check_extended_records(file, las_number<std::uint64_t>(&bytes[extended_at]),
                           las_number<std::uint32_t>(&bytes[extended_count_at]));
  }
  read_records(file, las_number<std::uint32_t>(&bytes[records_at]), header);
  check_points(file, header);
  return header;
}

bool is_compressed_las(const std::filesystem::path& path) {
  std::array<char, format_at + 1> start{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(start.data(), start.size())) return false;
  return std::string_view(start.data(), 4) == "LASF" && (start[format_at] & compressed_bit);
}

}  // namespace igsp::io
