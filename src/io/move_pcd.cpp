#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "io/move_bodies.hpp"
#include "io/number_text.hpp"
#include "io/pcd_compressed.hpp"
#include "io/pcd_header.hpp"

namespace igsp::io {

namespace {

std::vector<RecordField> fields_of(const InputFile& file, const PcdHeader& header) {
  std::vector<RecordField> fields;
  for (const PcdField& field : header.fields) {
    fields.push_back({field.name, scalar_type_of(file, field), field.count, {}});
  }
  return fields;
}

/// VIEWPOINT, the pose of the sensor, moved; the line itself where it says nothing else then.
std::string moved_viewpoint(std::string_view line, const MoveJob& job) {
  const auto words = split_words(line);
  const auto read = parse_pcd_pose(std::span<const std::string_view>(words).subspan(1));
  if (!read) return std::string(line);
  const PcdPose& pose = *read;
  if (!job.viewpoint && pose == default_pcd_pose) return std::string(line);
  const Eigen::Vector3d stated(pose[0], pose[1], pose[2]);
  const Eigen::Vector3d position = moved(job.viewpoint.value_or(stated), false, job.transformation);
  const Eigen::Quaterniond turned = Eigen::Quaterniond(job.transformation.linear()).normalized() *
                                    Eigen::Quaterniond(pose[3], pose[4], pose[5], pose[6]);
  const PcdPose after{position.x(), position.y(), position.z(), turned.w(), turned.x(), turned.y(), turned.z()};
  return after == pose ? std::string(line) : fmt::format("VIEWPOINT {}", fmt::join(after, " "));
}

/// The header as it is, save the pose of the sensor and what is written as doubles.
void write_header(MoveJob& job, const std::vector<RecordField>& fields, const RecordMotion& motion) {
  const auto with_doubles = [&](std::string_view line, std::string_view value) {
    auto words = split_words(line);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (motion.written[i] != fields[i].type) words[i + 1] = value;
    }
    return fmt::format("{}", fmt::join(words, " "));
  };
  job.copy_lines_read([&](std::string_view line) {
    const auto words = split_words(line);
    const std::string_view key = words.empty() ? std::string_view() : words[0];
    if (key == "VIEWPOINT") return moved_viewpoint(line, job);
    if (motion.changes_types && key == "SIZE") return with_doubles(line, "8");
    if (motion.changes_types && key == "TYPE") return with_doubles(line, "F");
    return std::string(line);
  });
}

void move_point_lines(MoveJob& job, const PcdHeader& header, const std::vector<RecordField>& fields,
                      const RecordMotion& motion) {
  LineMotion lines;
  lines.table.remaining = header.points;
  std::vector<std::size_t> first_value;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    first_value.push_back(lines.table.columns.size());
    if (lines.table.columns.size() + fields[i].count > InputFile::buffer_size) {
      job.file.fail_at_line("too many values for one point");
    }
    lines.table.columns.insert(lines.table.columns.end(), fields[i].count, coordinate_named(fields[i].name));
    lines.written.insert(lines.written.end(), fields[i].count, motion.written[i]);
  }
  for (MovedFields moved : motion.moved) {
    for (std::size_t& field : moved.fields) field = first_value[field];
    lines.moved.push_back(moved);
  }
  move_lines(job, lines);
}

void move_compressed(MoveJob& job, const PcdHeader& header, const std::vector<RecordField>& fields,
                     const RecordMotion& motion) {
  const std::vector<char> read = read_pcd_compressed(job.file, header);
  std::string written;
  std::vector<std::size_t> read_offsets, written_offsets;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    read_offsets.push_back(offset);
    written_offsets.push_back(written.size());
    const std::size_t size = fields[i].count * header.points * size_of(fields[i].type);
    if (motion.written[i] == fields[i].type)
      written.append(read.data() + offset, size);
    else
      written.append(header.points * size_of(motion.written[i]), '\0');
    offset += size;
  }
  for (const MovedFields& moved : motion.moved) {
    std::array<MovedValue, 3> values;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t i = moved.fields[axis];
      values[axis] = {fields[i].type,          motion.written[i],  read_offsets[i],
                      size_of(fields[i].type), written_offsets[i], size_of(motion.written[i])};
    }
    move_values(job.file, values, moved.direction, std::endian::little, job.transformation, header.points, read.data(),
                written.data());
  }
  job.bytes += compressed_pcd(written);
  job.flush();
}

}  // namespace

bool move_pcd(MoveJob& job, bool doubles) {
  const PcdHeader header = read_pcd_header(job.file);
  const std::vector<RecordField> fields = fields_of(job.file, header);
  const RecordMotion motion = motion_of(fields, doubles);
  write_header(job, fields, motion);
  if (header.format == FileFormat::pcd_ascii) {
    move_point_lines(job, header, fields, motion);
  } else if (header.format == FileFormat::pcd_binary) {
    move_fixed_records(job, header.points, FixedMotion(fields, motion, std::endian::little));
  } else if (header.points > 0) {
    move_compressed(job, header, fields, motion);
  }
  job.copy_rest();
  return motion.changes_types;
}

}  // namespace igsp::io
