#include <fmt/format.h>

#include <algorithm>

#include "io/binary_records.hpp"
#include "io/move_bodies.hpp"
#include "io/number_text.hpp"
#include "io/ply_header.hpp"

namespace igsp::io {

namespace {

std::vector<RecordField> fields_of(const PlyElement& element) {
  std::vector<RecordField> fields;
  for (const PlyProperty& property : element.properties) {
    fields.push_back({property.name, property.type, 1, property.list_length});
  }
  return fields;
}

/// The header as it is, save the viewpoint, and that properties whose values are written as doubles say so.
void write_header(MoveJob& job, const PlyHeader& header, const std::vector<RecordMotion>& motions) {
  std::size_t element = 0, property = 0;
  job.copy_lines_read([&](std::string_view line) {
    const auto words = split_words(line);
    if (const auto viewpoint = ply_viewpoint(words)) {
      const Eigen::Vector3d after = moved(job.viewpoint.value_or(*viewpoint), false, job.transformation);
      return after == *viewpoint ? std::string(line) : ply_viewpoint_comment(after);
    }
    if (!words.empty() && words[0] == "element") {
      ++element;
      property = 0;
    }
    if (words.empty() || words[0] != "property") return std::string(line);
    const PlyProperty& read = header.elements[element - 1].properties[property];
    const bool changed = motions[element - 1].written[property++] != read.type;
    return changed ? fmt::format("property double {}", read.name) : std::string(line);
  });
}

/// The bytes of a list that come behind its length, which is appended.
std::uint64_t read_list_length(InputFile& file, const RecordField& field, std::endian byte_order, std::string& bytes) {
  const std::string_view written = file.read(size_of(*field.list_length));
  bytes += written;
  const std::uint64_t size = list_bytes(file, written, *field.list_length, field.type, byte_order);
  file.require_records(1, size, "lists");
  return size;
}

/// Records in which nothing moves, such as faces.
void copy_list_records(MoveJob& job, std::uint64_t count, const std::vector<RecordField>& fields,
                       std::endian byte_order) {
  for (; count > 0; --count) {
    for (const RecordField& field : fields) {
      job.copy(field.list_length ? read_list_length(job.file, field, byte_order, job.bytes) : size_of(field.type));
    }
  }
}

void move_list_records(MoveJob& job, std::uint64_t count, const std::vector<RecordField>& fields,
                       const RecordMotion& motion, std::endian byte_order) {
  std::string record;
  std::vector<std::size_t> read_offsets(fields.size()), written_offsets(fields.size());
  for (; count > 0; --count) {
    record.clear();
    const std::size_t begin = job.bytes.size();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      read_offsets[i] = record.size();
      written_offsets[i] = job.bytes.size() - begin;
      std::uint64_t size = size_of(fields[i].type);
      if (fields[i].list_length) size = read_list_length(job.file, fields[i], byte_order, record);
      while (size > 0) {
        const std::uint64_t now = std::min<std::uint64_t>(size, InputFile::buffer_size);
        record += job.file.read(now);
        size -= now;
      }
      if (motion.written[i] == fields[i].type)
        job.bytes.append(record, read_offsets[i]);
      else
        job.bytes.append(size_of(motion.written[i]), '\0');
    }
    for (const MovedFields& moved : motion.moved) {
      std::array<MovedValue, 3> values;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t i = moved.fields[axis];
        values[axis] = {fields[i].type, motion.written[i], read_offsets[i], 0, written_offsets[i], 0};
      }
      move_values(job.file, values, moved.direction, byte_order, job.transformation, 1, record.data(),
                  job.bytes.data() + begin);
    }
    job.flush_if_full();
  }
}

void move_binary_element(MoveJob& job, const PlyElement& element, const RecordMotion& motion, FileFormat format) {
  const std::vector<RecordField> fields = fields_of(element);
  const std::endian byte_order = byte_order_of(format);
  const bool lists =
      std::ranges::any_of(fields, [](const RecordField& field) { return field.list_length.has_value(); });
  if (!lists) return move_fixed_records(job, element.count, FixedMotion(fields, motion, byte_order));
  if (motion.moved.empty()) return copy_list_records(job, element.count, fields, byte_order);
  move_list_records(job, element.count, fields, motion, byte_order);
}

void copy_lines(MoveJob& job, const PlyElement& element) {
  if (element.properties.empty()) return;
  std::string_view line;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (!job.file.read_line(line)) {
      job.file.fail_at_line(
          fmt::format("the file ends after {} of {} '{}' elements: truncated", i, element.count, element.name));
    }
    job.bytes += line;
    job.bytes += job.file.line_end();
    job.flush_if_full();
  }
}

void move_element_lines(MoveJob& job, const PlyElement& element, const RecordMotion& motion) {
  LineMotion lines{{}, motion.moved, motion.written};
  lines.table.remaining = element.count;
  for (const PlyProperty& property : element.properties) {
    lines.table.columns.push_back(property.list_length ? Column::list : coordinate_named(property.name));
  }
  move_lines(job, lines);
}

}  // namespace

bool move_ply(MoveJob& job, bool doubles) {
  const PlyHeader header = read_ply_header(job.file);
  const std::size_t vertex = find_vertex(job.file, header);
  std::vector<RecordMotion> motions;
  for (const PlyElement& element : header.elements) motions.push_back(motion_of(fields_of(element), doubles));
  write_header(job, header, motions);
  for (std::size_t i = 0; i < header.elements.size(); ++i) {
    const PlyElement& element = header.elements[i];
    if (header.format != FileFormat::ply_ascii)
      move_binary_element(job, element, motions[i], header.format);
    else if (motions[i].moved.empty())
      copy_lines(job, element);
    else
      move_element_lines(job, element, motions[i]);
  }
  job.copy_rest();
  return motions[vertex].changes_types;
}

}  // namespace igsp::io
