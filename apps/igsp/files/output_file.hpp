#pragma once

#include <filesystem>
#include <string_view>

#include "io/atomic_file.hpp"
#include "shell/interrupt.hpp"

namespace igsp::cli {

/// Also through links and detours.
inline bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  return weakly_canonical(absolute(a, ignored), ignored) == weakly_canonical(absolute(b, ignored), ignored);
}

/// Throws FileError unless a file can be created at `path`: asked before a long run, not after it.
inline void check_writable(const std::filesystem::path& path) {
  io::AtomicFile{path};
}

/// Whole or not at all. Throws FileError, Cancelled.
inline void write_text(const std::filesystem::path& path, std::string_view text) {
  io::AtomicFile file(path);
  file.write(text);
  stop_if_interrupted();
  file.commit();
}

}  // namespace igsp::cli
