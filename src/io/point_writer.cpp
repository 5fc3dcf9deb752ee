#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "io/atomic_file.hpp"
#include "io/file_format.hpp"
#include "io/number_text.hpp"
#include "io/point_writers.hpp"

namespace igsp {

namespace io {

namespace {

constexpr std::size_t flush_size = std::size_t{1} << 16;

template <typename Append>
void write_each(AtomicFile& file, const ChunkSource& chunks, Append append) {
  std::string bytes;
  for (PointView chunk = chunks(); !chunk.empty(); chunk = chunks()) {
    for (const Eigen::Vector3d& point : chunk) {
      append(bytes, point);
      if (bytes.size() < flush_size) continue;
      file.write(bytes);
      bytes.clear();
    }
  }
  file.write(bytes);
}

template <typename Scalar>
void append_scalar(std::string& bytes, Scalar value, std::endian byte_order) {
  auto raw = std::bit_cast<std::array<char, sizeof(Scalar)>>(value);
  if (byte_order != std::endian::native) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

}  // namespace

void append_binary(std::string& bytes, double value, bool single_precision, std::endian byte_order) {
  if (single_precision) {
    append_scalar(bytes, static_cast<float>(value), byte_order);
  } else {
    append_scalar(bytes, value, byte_order);
  }
}

void write_lines(AtomicFile& file, const ChunkSource& chunks, bool single_precision, char separator) {
  write_each(file, chunks, [&](std::string& text, const Eigen::Vector3d& point) {
    for (int axis = 0; axis < 3; ++axis) {
      // The digits of the rounded value as a double: read back as a double it is then that value in every format.
      append_number(text, single_precision ? static_cast<double>(static_cast<float>(point[axis])) : point[axis]);
      text += axis < 2 ? separator : '\n';
    }
  });
}

void write_records(AtomicFile& file, const ChunkSource& chunks, bool single_precision, std::endian byte_order) {
  write_each(file, chunks, [&](std::string& bytes, const Eigen::Vector3d& point) {
    for (const double value : point) append_binary(bytes, value, single_precision, byte_order);
  });
}

}  // namespace io

namespace {

void require_writable(PointView points, std::size_t first, bool single_precision) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const double value : points[i]) {
      if (std::isfinite(single_precision ? static_cast<float>(value) : value)) continue;
      throw InvalidArgument(fmt::format("points[{}] has the coordinate {}, which is not finite{}", first + i, value,
                                        single_precision ? " in single precision" : ""));
    }
  }
}

}  // namespace

void write_points(const std::filesystem::path& path, PointView points, const WriteOptions& options) {
  bool given = false;
  const ChunkSource once = [&] { return std::exchange(given, true) ? PointView() : points; };
  write_points(path, points.size(), once, options);
}

void write_points(const std::filesystem::path& path, std::size_t count, const ChunkSource& chunks,
                  const WriteOptions& options) {
  const FileFormat format = options.format ? *options.format : format_of(path);
  const io::WriteJob job{format, count, options.single_precision, io::extension_of(path), options.viewpoint};
  if (options.viewpoint && !options.viewpoint->allFinite()) {
    throw InvalidArgument("options.viewpoint is not finite; three finite coordinates are needed");
  }
  if (format == FileFormat::las) {
    throw InvalidArgument(path.string() + ": points alone are not written as LAS; name it .ply, .pcd or .csv");
  }
  std::size_t written = 0;
  const ChunkSource checked = [&] {
    const PointView chunk = chunks();
    require_writable(chunk, written, options.single_precision);
    written += chunk.size();
    return chunk;
  };
  io::AtomicFile file(path);
  switch (io::family_of(format)) {
    case io::FormatFamily::ply:
      io::write_ply(file, checked, job);
      break;
    case io::FormatFamily::pcd:
      io::write_pcd(file, checked, job);
      break;
    case io::FormatFamily::text:
      io::write_text(file, checked, job);
      break;
    case io::FormatFamily::las:
    case io::FormatFamily::unknown:
      throw InvalidArgument("options.format is none of the formats");
  }
  if (written != count) throw InvalidArgument(fmt::format("count = {}, but {} points came", count, written));
  file.commit();
}

}  // namespace igsp
