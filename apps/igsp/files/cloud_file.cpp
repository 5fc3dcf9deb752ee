#include "files/cloud_file.hpp"

namespace igsp::cli {
namespace {

std::string_view name_of(FileFormat format) {
  switch (format) {
    case FileFormat::ply_ascii:
      return "PLY, ascii";
    case FileFormat::ply_binary_little_endian:
      return "PLY, binary little endian";
    case FileFormat::ply_binary_big_endian:
      return "PLY, binary big endian";
    case FileFormat::pcd_ascii:
      return "PCD, ascii";
    case FileFormat::pcd_binary:
      return "PCD, binary";
    case FileFormat::pcd_binary_compressed:
      return "PCD, binary compressed";
    case FileFormat::las:
      return "LAS";
    case FileFormat::text:
      return "text";
  }
  return "";
}

std::variant<PointReader, ForeignCloud> open(const std::filesystem::path& path, const ReadOptions& options) {
  if (reads_foreign(path)) return open_foreign(path, options.keep_noise);
  check_not_foreign(path);
  return PointReader(path, PointReader::default_chunk, options);
}

}  // namespace

CloudFile::CloudFile(const std::filesystem::path& path, const ReadOptions& options) : reader_(open(path, options)) {}

PointView CloudFile::next_chunk() {
  return std::visit([](auto& reader) { return reader.next_chunk(); }, reader_);
}

std::string CloudFile::format() const {
  const PointReader* own = std::get_if<PointReader>(&reader_);
  return own ? std::string(name_of(own->format())) : std::get<ForeignCloud>(reader_).format;
}

std::size_t CloudFile::dropped() const {
  return std::visit([](const auto& reader) { return reader.dropped(); }, reader_);
}

std::size_t CloudFile::declared_points() const {
  const PointReader* own = std::get_if<PointReader>(&reader_);
  return own ? own->declared_points() : 0;
}

std::optional<Eigen::Vector3d> CloudFile::viewpoint() const {
  return std::visit([](const auto& reader) { return reader.viewpoint(); }, reader_);
}

std::size_t CloudFile::noise() const {
  return std::visit([](const auto& reader) { return reader.noise(); }, reader_);
}

std::size_t CloudFile::part() const {
  const ForeignCloud* foreign = std::get_if<ForeignCloud>(&reader_);
  return foreign ? foreign->part() : 0;
}

std::vector<ScanPart> CloudFile::parts() const {
  const ForeignCloud* foreign = std::get_if<ForeignCloud>(&reader_);
  return foreign ? foreign->parts() : std::vector<ScanPart>();
}

}  // namespace igsp::cli
