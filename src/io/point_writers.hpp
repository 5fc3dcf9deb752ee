#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>

#include "igsp/io.hpp"
#include "io/atomic_file.hpp"

namespace igsp::io {

/// How coordinates leave: the format is known here, and `extension` (lower case) tells the kinds of text apart.
struct WriteJob {
  FileFormat format = FileFormat::text;
  std::uint64_t count = 0;  ///< points that come
  bool single_precision = false;
  std::string extension;
  std::optional<Eigen::Vector3d> viewpoint = {};
};

void write_ply(AtomicFile& file, const ChunkSource& chunks, const WriteJob& job);
void write_pcd(AtomicFile& file, const ChunkSource& chunks, const WriteJob& job);
void write_text(AtomicFile& file, const ChunkSource& chunks, const WriteJob& job);

/// A line for every point.
void write_lines(AtomicFile& file, const ChunkSource& chunks, bool single_precision, char separator);
/// x, y, z of one point behind those of the other.
void write_records(AtomicFile& file, const ChunkSource& chunks, bool single_precision, std::endian byte_order);
void append_binary(std::string& bytes, double value, bool single_precision, std::endian byte_order);

}  // namespace igsp::io
