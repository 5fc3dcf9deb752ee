#pragma once

#include <filesystem>
#include <string_view>

namespace igsp::cli {

/// Also through links and detours.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// With all folders above it. Throws FileError.
void make_folder(const std::filesystem::path& folder);

/// Throws FileError unless a file can be created at `path`: asked before a long run, not after it.
void check_writable(const std::filesystem::path& path);

/// Whole or not at all. Throws FileError, Cancelled.
void write_text(const std::filesystem::path& path, std::string_view text);

}  // namespace igsp::cli
