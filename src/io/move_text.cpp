#include "io/file_format.hpp"
#include "io/move_bodies.hpp"
#include "io/text_layout.hpp"

namespace igsp::io {

namespace {

LineMotion line_motion(const TextLayout& layout, const std::string& extension) {
  LineMotion motion{{layout.columns, layout.count.value_or(TextTable::until_end), true, layout.syntax}, {}, {}};
  MovedFields coordinates;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    if (layout.columns[i] != Column::skip) coordinates.fields[static_cast<std::size_t>(layout.columns[i])] = i;
  }
  motion.moved.push_back(coordinates);
  for (const MovedFields& named : find_moved_fields(layout.names)) {
    if (named.direction) motion.moved.push_back(named);
  }
  const bool normals_behind = extension == ".xyzn" && layout.names.empty();
  if (normals_behind) motion.moved.push_back({{3, 4, 5}, true});
  return motion;
}

}  // namespace

void move_text(MoveJob& job, const std::vector<std::string>& columns) {
  const TextLayout layout = read_text_layout(job.file, columns);
  const LineMotion motion = line_motion(layout, extension_of(job.file.path()));
  job.copy_lines_read([](std::string_view line) { return std::string(line); });
  move_lines(job, motion);
}

}  // namespace igsp::io
