#include "io/las_fields.hpp"
#include "io/rows.hpp"

namespace igsp::io {

RowSource open_las_rows(InputFile& file, bool keep_noise) {
  RowSource rows;
  const LasHeader header = read_las_header(file);
  const std::vector<LasField> fields = las_fields(header);
  rows.fields = {{"x", ScalarType::float64}, {"y", ScalarType::float64}, {"z", ScalarType::float64}};
  rows.coordinates = {0, 1, 2};
  for (const LasField& field : fields) rows.fields.push_back({field.name, field.type});
  rows.next = [&file, header, fields, keep_noise, left = header.count](std::span<double> row) mutable {
    while (left > 0) {
      --left;
      const char* record = file.read(header.record_length).data();
      if (!keep_noise && header.is_noise(record)) continue;
      const Eigen::Vector3d position = header.position(record);
      for (int axis = 0; axis < 3; ++axis) row[static_cast<std::size_t>(axis)] = position[axis];
      for (std::size_t i = 0; i < fields.size(); ++i) {
        row[3 + i] = checked_value(file, fields[i].value(record), fields[i].type);
      }
      return true;
    }
    return false;
  };
  return rows;
}

}  // namespace igsp::io
