#pragma once

#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <string_view>

namespace igsp::io {

/// A file that appears under its name only when it is complete, and is on the disk by then: written without a name
/// where the file system can (a process that is killed leaves nothing), else to a temporary one in the same folder;
/// renamed by commit(), removed if commit() is never reached. A file that it replaces passes on its permissions and,
/// where that is allowed, its owner; a link is followed, also to a file that is not there. Throws FileError.
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
  std::filesystem::path behind_links() const;
  std::filesystem::path folder() const;
  bool open_without_name(mode_t mode);
  void open_with_name(mode_t mode);
  void keep_permissions(const struct stat& replaced) const;
  /// Calls `create` with temporary names until one is free; false where that is not the reason to fail.
  template <typename Create>
  bool find_free_name(const Create& create);
  void give_name();
  void sync_folder() const;

  std::filesystem::path path_;       // as the caller named it
  std::filesystem::path target_;     // behind symbolic links
  std::filesystem::path temporary_;  // empty when there is none
  std::FILE* file_ = nullptr;
};

}  // namespace igsp::io
