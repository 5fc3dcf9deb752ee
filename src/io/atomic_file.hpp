#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

namespace igsp::io {

/// A file that appears under its name only when it is complete: written to a temporary name in the same folder, renamed
/// by commit(), removed if commit() is never reached. Throws FileError.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail(std::string_view what, int error_number) const;
  void open_temporary();

  std::filesystem::path path_;       // as the caller named it
  std::filesystem::path target_;     // behind symbolic links
  std::filesystem::path temporary_;  // empty when there is none
  std::FILE* file_ = nullptr;
};

}  // namespace igsp::io
