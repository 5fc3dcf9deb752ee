#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/binary_records.hpp"
#include "io/file_format.hpp"
#include "io/point_body.hpp"
#include "io/rows.hpp"

namespace igsp::io {

double checked_value(const InputFile& file, double value, ScalarType type) {
  const bool wide = type == ScalarType::int64 || type == ScalarType::uint64;
  if (wide && std::abs(value) > 0x1p53) {
    file.fail_at_offset(file.offset(), fmt::format("the integer {:.0f} is beyond 2^53: it cannot be converted", value));
  }
  return value;
}

std::function<bool(std::span<double>)> binary_rows(InputFile& file, std::vector<RowValue> values, std::uint64_t count,
                                                   std::endian byte_order) {
  std::vector<Decoder> decoders;
  std::uint64_t smallest = 0;
  for (const RowValue& value : values) {
    decoders.push_back(decoder_of(value.type, byte_order));
    smallest += size_of(value.list_length.value_or(value.type));
  }
  file.require_records(count, smallest, "points");
  return [&file, values = std::move(values), decoders = std::move(decoders), count,
          byte_order](std::span<double> row) mutable {
    if (count == 0) return false;
    --count;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const RowValue& value = values[i];
      if (value.list_length) {
        const std::string_view written = file.read(size_of(*value.list_length));
        file.skip(list_bytes(file, written, *value.list_length, value.type, byte_order));
        continue;
      }
      const char* bytes = file.read(size_of(value.type)).data();
      if (value.field) row[*value.field] = checked_value(file, decoders[i](bytes), value.type);
    }
    return true;
  };
}

RowSource open_rows(InputFile& file, const ReadOptions& options) {
  switch (find_family(file)) {
    case FormatFamily::ply:
      return open_ply_rows(file);
    case FormatFamily::pcd:
      return open_pcd_rows(file);
    case FormatFamily::las:
      return open_las_rows(file, options.keep_noise);
    default:
      return open_text_rows(file, options.columns);
  }
}

}  // namespace igsp::io
