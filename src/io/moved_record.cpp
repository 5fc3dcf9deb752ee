#include "io/moved_record.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace igsp::io {

namespace {

bool is_float(ScalarType type) {
  return type == ScalarType::float32 || type == ScalarType::float64;
}

bool is_unsigned(ScalarType type) {
  return type == ScalarType::uint8 || type == ScalarType::uint16 || type == ScalarType::uint32 ||
         type == ScalarType::uint64;
}

}  // namespace

RecordMotion motion_of(const std::vector<RecordField>& fields, bool doubles) {
  RecordMotion motion;
  std::vector<std::string> names;
  for (const RecordField& field : fields) {
    names.push_back(field.name);
    motion.written.push_back(field.type);
  }
  for (const MovedFields& moved : find_moved_fields(names)) {
    const auto any = [&](auto predicate) {
      return std::ranges::any_of(moved.fields, [&](std::size_t i) { return predicate(fields[i]); });
    };
    if (any([](const RecordField& field) { return field.list_length || field.count != 1; })) continue;
    // A direction without a sign is stored by a rule of its own.
    if (moved.direction && any([](const RecordField& field) { return is_unsigned(field.type); })) continue;
    motion.moved.push_back(moved);
    if (moved.direction) continue;
    for (const std::size_t i : moved.fields) {
      if (doubles || !is_float(fields[i].type)) motion.written[i] = ScalarType::float64;
      motion.changes_types = motion.changes_types || motion.written[i] != fields[i].type;
    }
  }
  return motion;
}

void move_values(const InputFile& file, const std::array<MovedValue, 3>& values, bool direction, std::endian byte_order,
                 const Transformation& transformation, std::uint64_t count, const char* read, char* written) {
  std::array<Decoder, 3> decoders{};
  std::array<Encoder, 3> encoders{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    decoders[axis] = decoder_of(values[axis].read, byte_order);
    encoders[axis] = encoder_of(values[axis].written, byte_order);
  }
  const std::array<ScalarType, 3> written_as{values[0].written, values[1].written, values[2].written};
  for (std::uint64_t i = 0; i < count; ++i) {
    Eigen::Vector3d before;
    for (int axis = 0; axis < 3; ++axis) {
      before[axis] = decoders[axis](read + values[axis].read_offset + i * values[axis].read_step);
    }
    const Eigen::Vector3d after = moved(before, direction, transformation);
    if (!direction && before.allFinite()) require_held(file, after, written_as);
    for (int axis = 0; axis < 3; ++axis) {
      const MovedValue& value = values[axis];
      const bool stays = before[axis] == after[axis] || std::isnan(before[axis]);
      if (stays && value.read == value.written) continue;
      encoders[axis](written + value.written_offset + i * value.written_step, after[axis]);
    }
  }
}

FixedMotion::FixedMotion(const std::vector<RecordField>& fields, const RecordMotion& motion, std::endian byte_order)
    : byte_order_(byte_order) {
  std::vector<std::size_t> read_offsets, written_offsets;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::size_t size = fields[i].count * size_of(fields[i].type);
    if (fields[i].type == motion.written[i]) {
      const bool behind = !kept_.empty() && kept_.back().read_offset + kept_.back().size == read_size_ &&
                          kept_.back().written_offset + kept_.back().size == written_size_;
      if (behind) {
        kept_.back().size += size;
      } else {
        kept_.push_back({read_size_, written_size_, size});
      }
    }
    read_offsets.push_back(read_size_);
    written_offsets.push_back(written_size_);
    read_size_ += size;
    written_size_ += fields[i].count * size_of(motion.written[i]);
  }
  for (const MovedFields& moved : motion.moved) {
    std::array<MovedValue, 3> values;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t i = moved.fields[axis];
      values[axis] = {fields[i].type, motion.written[i],  read_offsets[i],
                      read_size_,     written_offsets[i], written_size_};
    }
    values_.push_back(values);
    directions_.push_back(moved.direction);
  }
}

void FixedMotion::append(const InputFile& file, const char* records, std::uint64_t count,
                         const Transformation& transformation, std::string& bytes) const {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + count * written_size_);
  char* written = bytes.data() + begin;
  if (kept_.size() == 1 && kept_[0].size == read_size_) {
    std::memcpy(written, records, count * read_size_);
  } else {
    for (std::uint64_t i = 0; i < count; ++i) {
      for (const Run& run : kept_) {
        std::memcpy(written + i * written_size_ + run.written_offset, records + i * read_size_ + run.read_offset,
                    run.size);
      }
    }
  }
  for (std::size_t i = 0; i < values_.size(); ++i) {
    move_values(file, values_[i], directions_[i], byte_order_, transformation, count, records, written);
  }
}

}  // namespace igsp::io
