#pragma once

// What the fuzz targets share: libFuzzer hands out bytes, the readers want files.

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "io/rows.hpp"

namespace igsp::fuzzing {

/// A file of this process with these bytes, replaced by the next call with the same extension.
inline std::filesystem::path input_file(const std::uint8_t* data, std::size_t size, const std::string& extension) {
  const auto path = std::filesystem::temp_directory_path() / ("igsp_fuzz_" + std::to_string(getpid()) + extension);
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<long>(size));
  return path;
}

/// What stops the fuzzer: a promise is broken.
inline void require(bool holds) {
  if (!holds) std::abort();
}

/// Nothing if the file is refused with a FileError.
inline bool read_in_chunks(const std::filesystem::path& path, std::size_t points_per_chunk, Points& points) {
  try {
    PointReader reader(path, points_per_chunk);
    for (auto chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
      require(chunk.size() <= points_per_chunk);
      points.insert(points.end(), chunk.begin(), chunk.end());
    }
  } catch (const FileError&) {
    return false;
  }
  return true;
}

/// As igsp convert reads it: rows of numbers, or a FileError.
inline void read_rows(const std::filesystem::path& path) {
  try {
    io::InputFile file(path);
    io::RowSource rows = io::open_rows(file, {});
    std::vector<double> row(rows.fields.size());
    while (rows.next(row)) {
    }
  } catch (const FileError&) {
  }
}

/// Whatever the bytes, reading them either gives finite points or throws FileError, and the size of the chunks changes
/// nothing.
inline void check_reader(const std::filesystem::path& path) {
  read_rows(path);
  Points large, small;
  const bool read = read_in_chunks(path, PointReader::default_chunk, large);
  require(read == read_in_chunks(path, 3, small));
  if (!read) return;
  require(large == small);
  for (const auto& point : large) require(point.allFinite());
}

}  // namespace igsp::fuzzing
