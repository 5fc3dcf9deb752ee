#include "files/moved_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/report_progress.hpp"
#include "files/cloud_file.hpp"
#include "files/foreign_formats.hpp"
#include "igsp/errors.hpp"
#include "io/file_format.hpp"
#include "io/moved_copy.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

/// How exact moved coordinates are as floats, anywhere in the cloud's box.
double rounding_of_floats(const Bounds& bounds, const Transformation& target_from_source) {
  double largest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = (corner >> axis & 1 ? bounds.max : bounds.min)[axis];
    largest = std::max(largest, (target_from_source * point).cwiseAbs().maxCoeff());
  }
  return std::ldexp(largest, -24);
}

/// As it was settled, in the file's frame.
std::optional<Eigen::Vector3d> known_viewpoint(const CloudInput& source) {
  if (!source.viewpoint.viewpoint) return {};
  return *source.viewpoint.viewpoint / source.scale;
}

/// x, y and z of all points, in chunks.
void write_coordinates(const CloudInput& source, const fs::path& output, const Transformation& target_from_source,
                       bool floats, const ProgressCallback& progress) {
  CloudFile reader(source.path, source.options);
  Points moved;
  std::size_t read = 0;
  const ChunkSource chunks = [&]() -> PointView {
    report_progress(progress, "write", read, source.total);
    const PointView chunk = reader.next_chunk();
    read += chunk.size();
    moved.assign(chunk.begin(), chunk.end());
    for (Eigen::Vector3d& point : moved) point = target_from_source * point;
    return moved;
  };
  WriteOptions options{.single_precision = floats};
  const std::optional<Eigen::Vector3d> known = known_viewpoint(source);
  if (const auto& stood = known ? known : source.declared_viewpoint) options.viewpoint = target_from_source * *stood;
  write_points(output, source.total, chunks, options);
}

/// What is lost, and which name would keep it; nothing where the source holds no more.
std::vector<std::string> kept_coordinates_only(const CloudInput& source, const fs::path& output) {
  const std::string extension = source.path.extension().string();
  if (reads_foreign(source.path)) {
    return {fmt::format("{} keeps x, y and z only; -o with {} keeps all that belongs to the points", output.string(),
                        extension)};
  }
  std::vector<std::string> lost = io::other_properties(source.path, source.options);
  if (lost.empty()) return {};
  constexpr std::size_t named = 6;
  if (lost.size() > named) {
    lost.resize(named);
    lost.push_back("...");
  }
  return {fmt::format("{} keeps x, y and z only; -o with {} keeps {} as well", output.string(), extension,
                      fmt::join(lost, ", "))};
}

}  // namespace

// A survey format is written only from a source of the same format: it keeps what belongs to the points.
void check_moved_output(const fs::path& source, const fs::path& output) {
  if (moves_foreign(source, output)) return;
  if (reads_foreign(output)) {
    if (io::extension_of(source) == io::extension_of(output)) {
      throw InvalidArgument(fmt::format("-o {}: {} is only read; name it .ply, which holds the points", output.string(),
                                        output.extension().string()));
    }
    throw InvalidArgument(fmt::format("-o {}: {} is written only from a SOURCE of the same format, not from {}",
                                      output.string(), output.extension().string(), source.string()));
  }
  check_not_foreign(output);
  if (format_of(output) == FileFormat::las && !moves_las(source, output)) {
    throw InvalidArgument(fmt::format("-o {}: .las is written only from a SOURCE of the same format, not from {}",
                                      output.string(), source.string()));
  }
}

std::vector<std::string> write_moved_output(const CloudInput& source, const fs::path& output,
                                            const Transformation& target_from_source, double tolerance,
                                            const ProgressCallback& progress) {
  if (moves_foreign(source.path, output)) {
    write_moved_foreign(source.path, output, target_from_source);
    return {};
  }
  const double rounding = source.total > 0 ? rounding_of_floats(source.bounds, target_from_source) : 0.0;
  const bool floats = rounding <= tolerance;
  if (reads_foreign(source.path) || !io::keeps_properties(source.path, output)) {
    write_coordinates(source, output, target_from_source, floats, progress);
    return kept_coordinates_only(source, output);
  }
  const bool other_type = io::write_moved(
      source.path, output, target_from_source,
      {.read = source.options, .doubles = !floats, .progress = progress, .viewpoint = known_viewpoint(source)});
  if (!other_type) return {};
  return {fmt::format("{} holds its coordinates as doubles{}", output.string(),
                      floats ? ": the integers of the source cannot hold moved ones"
                             : fmt::format(": floats would be exact to {:.2g} only", rounding))};
}

}  // namespace igsp::cli
