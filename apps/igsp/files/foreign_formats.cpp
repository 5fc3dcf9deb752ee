#include "files/foreign_formats.hpp"

#include <fmt/format.h>

#include <map>

#include "igsp/errors.hpp"
#include "io/file_format.hpp"
#include "io/las_header.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

ForeignFormats& foreign_formats() {
  static ForeignFormats formats;
  return formats;
}

bool reads_itself(const fs::path& path) {
  const io::FormatFamily family = io::family_of(path);
  return family != io::FormatFamily::unknown && !(family == io::FormatFamily::las && io::is_compressed_las(path));
}

}  // namespace

void use_foreign_formats(ForeignFormats formats) {
  foreign_formats() = std::move(formats);
}

bool reads_foreign(const fs::path& path) {
  return !reads_itself(path) && foreign_formats().reads && foreign_formats().reads(path);
}

bool moves_foreign(const fs::path& source, const fs::path& output) {
  return !moves_las(source, output) && foreign_formats().moves && foreign_formats().moves(source, output);
}

bool moves_las(const fs::path& source, const fs::path& output) {
  const auto is_las = [](const fs::path& path) { return io::family_of(path) == io::FormatFamily::las; };
  return is_las(source) && is_las(output) && !io::is_compressed_las(source);
}

ForeignCloud open_foreign(const fs::path& path, bool keep_noise) {
  return foreign_formats().open(path, keep_noise);
}

std::vector<fs::path> scans_in(const fs::path& path) {
  if (!reads_foreign(path) || !foreign_formats().scans) return {path};
  try {
    const std::vector<std::string> names = foreign_formats().scans(path);
    return {names.begin(), names.end()};
  } catch (const FileError&) {
    return {path};
  }
}

fs::path file_of_scan(const fs::path& scan) {
  const std::string name = scan.string();
  const std::size_t mark = name.rfind('#');
  if (mark == std::string::npos || mark + 1 == name.size()) return scan;
  if (name.find_first_not_of("0123456789", mark + 1) != std::string::npos) return scan;
  std::error_code ignored;
  return fs::exists(scan, ignored) ? scan : fs::path(name.substr(0, mark));
}

void write_moved_foreign(const fs::path& source, const fs::path& output, const Transformation& target_from_source) {
  foreign_formats().write_moved(source, output, target_from_source);
}

bool writes_foreign_points(const fs::path& path) {
  return foreign_formats().writes_points && foreign_formats().writes_points(path);
}

void write_foreign_points(const fs::path& path, const ChunkSource& chunks, const CoordinateGrid& grid) {
  foreign_formats().write_points(path, chunks, grid);
}

void check_not_foreign(const fs::path& path) {
  const std::string extension = io::extension_of(path);
  static const std::map<std::string, std::string> extras = {{".e57", "[e57]"},  {".ptx", ""},       {".obj", "[mesh]"},
                                                            {".off", "[mesh]"}, {".stl", "[mesh]"}, {".vtk", ""}};
  const auto extra = extras.find(extension);
  if (extra == extras.end()) return;
  throw FileError(
      fmt::format("{}: this build of igsp does not know {} files; the same command from pip install 'igsp{}' does",
                  path.string(), extension, extra->second));
}

}  // namespace igsp::cli
