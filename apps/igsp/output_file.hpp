#pragma once

#include <filesystem>
#include <string_view>

namespace igsp::cli {

/// Throws FileError unless a file can be created at `path`: asked before a long run, not after it.
void check_writable(const std::filesystem::path& path);

/// Writes to a temporary name beside `path`, then renames; a device or pipe is written directly. Throws FileError.
void write_text(const std::filesystem::path& path, std::string_view text);

}  // namespace igsp::cli
