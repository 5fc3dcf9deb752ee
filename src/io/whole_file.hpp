#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace igsp::io {

/// All bytes of a regular file, which may be empty. Throws FileError, also for one of more than `limit` bytes.
std::string read_whole(const std::filesystem::path& path, std::uint64_t limit);

}  // namespace igsp::io
