#include "output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "igsp/errors.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw FileError(fmt::format("{}: cannot be written: {}", path.string(), why));
}

fs::path temporary_beside(const fs::path& path) {
  fs::path temporary = path;
  temporary += fmt::format(".{}.partial", getpid());
  return temporary;
}

bool is_device(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}

// Follows a link, so that the rename replaces the file and not the link to it.
fs::path link_target(const fs::path& path) {
  std::error_code ignored;
  return fs::is_symlink(path, ignored) && fs::exists(path, ignored) ? fs::canonical(path) : path;
}

void write_stream(const fs::path& path, std::string_view text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) fail(path, std::strerror(errno));
}

}  // namespace

void check_writable(const fs::path& path) {
  std::error_code ignored;
  if (path.filename().empty() || fs::is_directory(path, ignored)) fail(path, "is a directory");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) fail(path, fmt::format("there is no folder {}", folder.string()));
  if (is_device(path)) return;
  const fs::path temporary = temporary_beside(link_target(path));
  const int file = open(temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY, 0666);
  if (file < 0) fail(path, std::strerror(errno));
  close(file);
  unlink(temporary.c_str());
}

void write_text(const fs::path& path, std::string_view text) {
  if (is_device(path)) return write_stream(path, text);
  const fs::path final_path = link_target(path);
  const fs::path temporary = temporary_beside(final_path);
  try {
    write_stream(temporary, text);
    fs::rename(temporary, final_path);
  } catch (const std::exception& error) {
    unlink(temporary.c_str());
    fail(path, error.what());
  }
}

}  // namespace igsp::cli
