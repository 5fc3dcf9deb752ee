#pragma once

#include <bit>
#include <string>

#include "igsp/io.hpp"
#include "io/atomic_file.hpp"

namespace igsp::io {

/// How coordinates leave: the format is known here, and `extension` (lower case) tells the kinds of text apart.
struct WriteJob {
  FileFormat format = FileFormat::text;
  bool single_precision = false;
  std::string extension;
};

void write_ply(AtomicFile& file, PointView points, const WriteJob& job);
void write_pcd(AtomicFile& file, PointView points, const WriteJob& job);
void write_text(AtomicFile& file, PointView points, const WriteJob& job);

/// A line for every point.
void write_lines(AtomicFile& file, PointView points, bool single_precision, char separator);
/// x, y, z of one point behind those of the other.
void write_records(AtomicFile& file, PointView points, bool single_precision, std::endian byte_order);
void append_binary(std::string& bytes, double value, bool single_precision, std::endian byte_order);

}  // namespace igsp::io
