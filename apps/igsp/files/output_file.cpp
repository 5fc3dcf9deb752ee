#include "files/output_file.hpp"

#include <fmt/format.h>

#include <system_error>

#include "igsp/errors.hpp"
#include "io/atomic_file.hpp"
#include "shell/interrupt.hpp"

namespace igsp::cli {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return weakly_canonical(absolute(a, ignored), ignored) == weakly_canonical(absolute(b, ignored), ignored);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(fmt::format("{}: cannot be created: {}", folder.string(), error.message()));
}

void check_writable(const fs::path& path) {
  io::AtomicFile{path};
}

void write_text(const fs::path& path, std::string_view text) {
  io::AtomicFile file(path);
  file.write(text);
  stop_if_interrupted();
  file.commit();
}

}  // namespace igsp::cli
