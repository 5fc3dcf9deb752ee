#include "io/atomic_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

#include "igsp/errors.hpp"

namespace igsp::io {

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), target_(path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) fail("cannot write", EISDIR);
  if (std::filesystem::exists(status)) {
    // Renaming over a device or a pipe would replace it.
    if (!std::filesystem::is_regular_file(status))
      throw FileError(path_.string() + ": cannot write: not a regular file");
    target_ = std::filesystem::canonical(path, error);
    if (error) fail("cannot write", error.value());
  }
  open_temporary();
}

void AtomicFile::open_temporary() {
  constexpr int attempts = 1000;  // the others may be in use, or left by a process that was killed
  for (int i = 0; i < attempts; ++i) {
    std::filesystem::path candidate = target_;
    candidate.replace_filename(fmt::format(".{}.{}.tmp", target_.filename().string(), i));
    file_ = std::fopen(candidate.c_str(), "wbx");  // x: fails if it exists
    if (file_) {
      temporary_ = candidate;
      return;
    }
    if (errno != EEXIST) break;
  }
  fail("cannot create a temporary file beside it", errno);
}

AtomicFile::~AtomicFile() {
  if (file_) std::fclose(file_);
  std::error_code ignored;  // a destructor has no one to tell
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot write", errno);
}

void AtomicFile::commit() {
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (!closed) fail("cannot write", errno);
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) fail("cannot rename the complete file to its name", error.value());
  temporary_.clear();
}

void AtomicFile::fail(std::string_view what, int error_number) const {
  throw FileError(fmt::format("{}: {}: {}", path_.string(), what, std::generic_category().message(error_number)));
}

}  // namespace igsp::io
