// libFuzzer entry point: whatever the bytes, reading them either gives finite points or throws FileError, and the size
// of the chunks changes nothing.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "igsp/errors.hpp"
#include "igsp/io.hpp"

namespace {

/// A text extension: content that is neither PLY nor PCD goes on to the text reader.
const std::filesystem::path& input_path() {
  static const auto path = std::filesystem::temp_directory_path() / ("igsp_fuzz_" + std::to_string(getpid()) + ".txt");
  return path;
}

/// Nothing if the file is refused.
std::optional<igsp::Points> read_in_chunks(std::size_t points_per_chunk) {
  igsp::Points points;
  try {
    igsp::PointReader reader(input_path(), points_per_chunk);
    for (auto chunk = reader.next_chunk(); !chunk.empty(); chunk = reader.next_chunk()) {
      if (chunk.size() > points_per_chunk) std::abort();
      points.insert(points.end(), chunk.begin(), chunk.end());
    }
  } catch (const igsp::FileError&) {
    return std::nullopt;
  }
  for (const auto& point : points) {
    if (!point.allFinite()) std::abort();
  }
  return points;
}

void read_as_transformation() {
  try {
    igsp::read_transformation(input_path());
  } catch (const igsp::FileError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::ofstream(input_path(), std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<long>(size));
  if (read_in_chunks(igsp::PointReader::default_chunk) != read_in_chunks(3)) std::abort();
  read_as_transformation();
  return 0;
}
