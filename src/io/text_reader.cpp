#include "io/point_body.hpp"
#include "io/text_layout.hpp"

namespace igsp::io {

PointBody open_text(InputFile& file, const std::vector<std::string>& columns) {
  const TextLayout layout = read_text_layout(file, columns);
  TextTable table{layout.columns, layout.count.value_or(TextTable::until_end), true, layout.syntax};
  if (layout.count) table.require_records(file);
  return {FileFormat::text, layout.count.value_or(0), {}, table};
}

}  // namespace igsp::io
