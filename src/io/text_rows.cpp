#include <fmt/format.h>

#include <limits>

#include "io/number_text.hpp"
#include "io/rows.hpp"
#include "io/text_layout.hpp"

namespace igsp::io {

RowSource open_text_rows(InputFile& file, const std::vector<std::string>& columns) {
  const TextLayout layout = read_text_layout(file, columns);
  TextTable table{layout.columns, layout.count.value_or(TextTable::until_end), true, layout.syntax};
  if (layout.count) table.require_records(file);
  RowSource rows;
  std::string_view first;
  std::vector<std::string_view> sample;
  if (file.read_line(first)) {
    sample = cells_of(first, layout.syntax);
    file.unread_line();
  }
  std::vector<std::optional<std::size_t>> field_of_cell;
  for (std::size_t i = 0; i < std::max(sample.size(), layout.columns.size()); ++i) {
    const Column column = i < layout.columns.size() ? layout.columns[i] : Column::skip;
    const std::string name = i < layout.names.size() ? layout.names[i] : fmt::format("column_{}", i + 1);
    if (column == Column::skip && (i >= sample.size() || !parse_value(sample[i], layout.syntax))) {
      rows.left_out.push_back(name);
      field_of_cell.push_back(std::nullopt);
      continue;
    }
    if (column < Column::skip) rows.coordinates[static_cast<std::size_t>(column)] = rows.fields.size();
    field_of_cell.push_back(rows.fields.size());
    rows.fields.push_back(
        {column < Column::skip ? std::string(1, "xyz"[static_cast<std::size_t>(column)]) : name, ScalarType::float64});
  }
  rows.next = [&file, table, field_of_cell](std::span<double> row) mutable {
    std::string_view line;
    if (!table.next_line(file, line)) return false;
    parse_point(file, line, table);  // fails where it is none
    std::ranges::fill(row, std::numeric_limits<double>::quiet_NaN());
    const auto cells = cells_of(line, table.syntax);
    for (std::size_t i = 0; i < std::min(cells.size(), field_of_cell.size()); ++i) {
      const auto value = field_of_cell[i] ? parse_value(cells[i], table.syntax) : std::nullopt;
      if (value) row[*field_of_cell[i]] = *value;
    }
    return true;
  };
  return rows;
}

}  // namespace igsp::io
