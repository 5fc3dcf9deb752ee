#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "igsp/errors.hpp"

namespace igsp::io {
namespace {

constexpr mode_t for_owner_only = S_IRUSR | S_IWUSR;
constexpr mode_t for_all = 0666;  // less the umask
constexpr mode_t permission_bits = 07777;

std::string link_to(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), target_(behind_links()) {
  struct stat replaced {};
  const bool exists = stat(target_.c_str(), &replaced) == 0;
  if (exists) {
    if (S_ISDIR(replaced.st_mode)) fail("cannot write", EISDIR);
    // Renaming over a device or a pipe would replace it.
    if (!S_ISREG(replaced.st_mode)) throw FileError(path_.string() + ": cannot write: not a regular file");
    if (access(target_.c_str(), W_OK) != 0) fail("cannot write", errno);  // whom renaming would not stop
  }
  const mode_t mode = exists ? for_owner_only : for_all;
  if (!open_without_name(mode)) open_with_name(mode);
  if (exists) keep_permissions(replaced);
}

std::filesystem::path AtomicFile::behind_links() const {
  constexpr int longest_chain = 40;  // as the kernel has it
  std::filesystem::path file = path_;
  std::error_code error;
  for (int i = 0; std::filesystem::is_symlink(file, error); ++i) {
    if (i == longest_chain) fail("cannot write", ELOOP);
    const std::filesystem::path next = std::filesystem::read_symlink(file, error);
    if (error) fail("cannot write", error.value());
    file = file.parent_path() / next;
  }
  return file;
}

std::filesystem::path AtomicFile::folder() const {
  const std::filesystem::path folder = target_.parent_path();
  return folder.empty() ? "." : folder;
}

bool AtomicFile::open_without_name(mode_t mode) {
  const int descriptor = open(folder().c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
  if (descriptor == -1) return false;
  if (access(link_to(descriptor).c_str(), F_OK) == 0) file_ = fdopen(descriptor, "wb");
  if (!file_) close(descriptor);
  return file_ != nullptr;
}

void AtomicFile::open_with_name(mode_t mode) {
  int descriptor = -1;
  const bool created = find_free_name([&](const std::filesystem::path& name) {
    descriptor = open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, mode);
    return descriptor != -1;
  });
  if (created) file_ = fdopen(descriptor, "wb");
  if (!file_) fail("cannot create a temporary file beside it", errno);
}

template <typename Create>
bool AtomicFile::find_free_name(const Create& create) {
  constexpr int attempts = 1000;  // the others may be in use, or left by a process that was killed
  for (int i = 0; i < attempts; ++i) {
    // Short, so that every name that the file may have leaves room for it.
    const std::filesystem::path candidate = folder() / fmt::format(".igsp.{}.{}.tmp", getpid(), i);
    if (create(candidate)) {
      temporary_ = candidate;
      return true;
    }
    if (errno != EEXIST) return false;
  }
  return false;
}

void AtomicFile::keep_permissions(const struct stat& replaced) const {
  const int descriptor = fileno(file_);
  mode_t mode = replaced.st_mode & permission_bits;
  // Where the owner cannot be kept, the group may; what was meant for a group is not for another.
  if (fchown(descriptor, replaced.st_uid, replaced.st_gid) != 0) {
    mode &= 0777;
    if (fchown(descriptor, static_cast<uid_t>(-1), replaced.st_gid) != 0) mode &= ~static_cast<mode_t>(S_IRWXG);
  }
  fchmod(descriptor, mode);  // fails where the file system has no permissions
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
  if (std::fflush(file_) != 0) fail("cannot write", errno);
  // A name that is on the disk before its content would be an empty file after a power cut.
  if (fsync(fileno(file_)) != 0 && errno != EINVAL && errno != ENOTSUP) fail("cannot write", errno);
  if (temporary_.empty()) give_name();
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (!closed) fail("cannot write", errno);
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) fail("cannot rename the complete file to its name", error.value());
  temporary_.clear();
  sync_folder();
}

// Of the temporary file: only renaming replaces a file.
void AtomicFile::give_name() {
  const std::string link = link_to(fileno(file_));
  const bool linked = find_free_name([&](const std::filesystem::path& name) {
    return linkat(AT_FDCWD, link.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  });
  if (!linked) fail("cannot give the complete file a name", errno);
}

void AtomicFile::sync_folder() const {
  const int descriptor = open(folder().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor == -1) return;
  fsync(descriptor);  // not every file system can; the file is there in any case
  close(descriptor);
}

void AtomicFile::fail(std::string_view what, int error_number) const {
  throw FileError(fmt::format("{}: {}: {}", path_.string(), what, std::generic_category().message(error_number)));
}

}  // namespace igsp::io
