#include "io/moved_copy.hpp"

#include <fmt/format.h>

#include "io/file_format.hpp"
#include "io/las_fields.hpp"
#include "io/move_job.hpp"
#include "io/number_text.hpp"
#include "io/pcd_header.hpp"
#include "io/ply_header.hpp"
#include "io/point_body.hpp"
#include "io/text_layout.hpp"

namespace igsp::io {

namespace {

namespace fs = std::filesystem;

/// Text whose lines another program expects to look different.
bool is_kind_of_its_own(const fs::path& text) {
  const std::string extension = extension_of(text);
  return extension == ".csv" || extension == ".pts" || extension == ".tsv" || extension == ".xyzn";
}

std::vector<std::string> other_ply_properties(InputFile& file) {
  const PlyHeader header = read_ply_header(file);
  const std::size_t vertex = find_vertex(file, header);
  std::vector<std::string> names;
  for (const PlyProperty& property : header.elements[vertex].properties) {
    if (property.list_length || coordinate_named(property.name) == Column::skip) names.push_back(property.name);
  }
  for (std::size_t i = 0; i < header.elements.size(); ++i) {
    const PlyElement& element = header.elements[i];
    if (i != vertex && element.count > 0) names.push_back(fmt::format("{} x {}", element.count, element.name));
  }
  return names;
}

std::vector<std::string> other_pcd_properties(InputFile& file) {
  std::vector<std::string> names;
  for (const PcdField& field : read_pcd_header(file).fields) {
    if (coordinate_named(field.name) == Column::skip && field.name != "_") names.push_back(field.name);
  }
  return names;
}

std::vector<std::string> other_las_properties(InputFile& file) {
  std::vector<std::string> names;
  for (const LasField& field : las_fields(read_las_header(file))) names.push_back(field.name);
  return names;
}

std::vector<std::string> other_columns(InputFile& file, const ReadOptions& options) {
  const TextLayout layout = read_text_layout(file, options.columns);
  std::string_view line;
  std::size_t columns = layout.names.size();
  if (columns == 0 && file.read_line(line)) {
    columns = split(without_brackets(line, layout.syntax), layout.syntax.separator.value_or(separator_of(line))).size();
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < columns; ++i) {
    if (i < layout.columns.size() && layout.columns[i] != Column::skip) continue;
    names.push_back(layout.names.empty() ? fmt::format("column {}", i + 1) : layout.names[i]);
  }
  return names;
}

}  // namespace

bool keeps_properties(const fs::path& source, const fs::path& destination) {
  InputFile file(source);
  const FormatFamily family = find_family(file);
  if (family != family_of(format_of(destination))) return false;
  if (family != FormatFamily::text || extension_of(source) == extension_of(destination)) return true;
  return !is_kind_of_its_own(source) && !is_kind_of_its_own(destination);
}

std::vector<std::string> other_properties(const fs::path& source, const ReadOptions& options) {
  InputFile file(source);
  switch (find_family(file)) {
    case FormatFamily::ply:
      return other_ply_properties(file);
    case FormatFamily::pcd:
      return other_pcd_properties(file);
    case FormatFamily::las:
      return other_las_properties(file);
    default:
      return other_columns(file, options);
  }
}

bool write_moved(const fs::path& source, const fs::path& destination, const Transformation& destination_from_source,
                 const MoveOptions& options) {
  InputFile file(source);
  const FormatFamily family = find_family(file);
  AtomicFile output(destination);
  MoveJob job(file, output, destination_from_source, options);
  bool other_type = false;
  switch (family) {
    case FormatFamily::ply:
      other_type = move_ply(job, options.doubles);
      break;
    case FormatFamily::pcd:
      other_type = move_pcd(job, options.doubles);
      break;
    case FormatFamily::las:
      move_las(job);
      break;
    default:
      move_text(job, options.read.columns);
  }
  job.flush();
  output.commit();
  return other_type;
}

}  // namespace igsp::io
