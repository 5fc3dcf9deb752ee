#include <algorithm>
#include <variant>

#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "io/chunk.hpp"
#include "io/file_format.hpp"
#include "io/point_body.hpp"

namespace igsp {

namespace io {

namespace {

/// What the first bytes are: PCD has no magic of its own, so its first line that is no comment decides.
FormatFamily family_of_content(InputFile& file) {
  std::string_view start = file.peek(4096);
  if (start.starts_with("ply\n") || start.starts_with("ply\r") || start.starts_with("ply ")) return FormatFamily::ply;
  if (start.starts_with("LASF")) return FormatFamily::las;
  if (start.starts_with("# .PCD")) return FormatFamily::pcd;
  while (start.starts_with('#')) start.remove_prefix(std::min(start.find_first_of("\r\n"), start.size() - 1) + 1);
  for (const auto keyword : {"VERSION ", "FIELDS ", "COLUMNS "}) {
    if (start.starts_with(keyword)) return FormatFamily::pcd;
  }
  return FormatFamily::unknown;
}

}  // namespace

FormatFamily find_family(InputFile& file) {
  file.detect_encoding();
  const FormatFamily found = family_of_content(file);
  if (found != FormatFamily::unknown) return found;
  switch (family_of(format_of(file.path()))) {
    case FormatFamily::ply:
      file.fail_at_offset(0, "not a PLY file: it does not start with a line 'ply'");
    case FormatFamily::pcd:
      file.fail_at_offset(0, "not a PCD file: it starts neither with '# .PCD' nor with VERSION");
    case FormatFamily::las:
      file.fail_at_offset(0, "not a LAS file: it does not begin with LASF");
    default:
      return FormatFamily::text;
  }
}

PointBody open_body(InputFile& file, const ReadOptions& options) {
  switch (find_family(file)) {
    case FormatFamily::ply:
      return open_ply(file);
    case FormatFamily::pcd:
      return open_pcd(file);
    case FormatFamily::las:
      return open_las(file, options.keep_noise);
    default:
      return open_text(file, options.columns);
  }
}

}  // namespace io

struct PointReader::Implementation {
  Implementation(const std::filesystem::path& path, std::size_t points_per_chunk, const ReadOptions& options)
      : file(path), body(io::open_body(file, options)) {
    chunk.limit = points_per_chunk;
  }

  io::InputFile file;
  io::PointBody body;
  io::Chunk chunk;
};

PointReader::PointReader(const std::filesystem::path& path, std::size_t points_per_chunk, const ReadOptions& options) {
  if (points_per_chunk == 0) throw InvalidArgument("points_per_chunk = 0 is not in [1, infinity)");
  const auto& columns = options.columns;
  if (!columns.empty() && columns.size() != 3) {
    throw InvalidArgument("columns names " + std::to_string(columns.size()) + " columns; it must be three: x, y and z");
  }
  if (std::ranges::any_of(columns, &std::string::empty)) throw InvalidArgument("columns holds an empty name");
  implementation_ = std::make_unique<Implementation>(path, points_per_chunk, options);
}

PointReader::~PointReader() = default;
PointReader::PointReader(PointReader&&) noexcept = default;
PointReader& PointReader::operator=(PointReader&&) noexcept = default;

PointView PointReader::next_chunk() {
  Implementation& state = *implementation_;
  state.chunk.points.clear();
  std::visit([&](auto& records) { records.fill(state.file, state.chunk); }, state.body.records);
  return state.chunk.points;
}

FileFormat PointReader::format() const {
  return implementation_->body.format;
}
std::size_t PointReader::dropped() const {
  return implementation_->chunk.dropped;
}
std::size_t PointReader::noise() const {
  return implementation_->chunk.noise;
}
std::size_t PointReader::declared_points() const {
  return implementation_->body.declared_points;
}

std::optional<Eigen::Vector3d> PointReader::viewpoint() const {
  return implementation_->body.viewpoint;
}

LoadedCloud read_points(const std::filesystem::path& path, const ReadOptions& options) {
  PointReader reader(path, PointReader::default_chunk, options);
  LoadedCloud cloud;
  cloud.format = reader.format();
  cloud.viewpoint = reader.viewpoint();
  cloud.points.reserve(reader.declared_points());
  for (PointView chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
    cloud.points.insert(cloud.points.end(), chunk.begin(), chunk.end());
  }
  cloud.dropped = reader.dropped();
  cloud.noise = reader.noise();
  return cloud;
}

}  // namespace igsp
