#include "io/atomic_file.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cmath>
#include <limits>
#include <string>

#include "io/io_testing.hpp"

namespace igsp::io {
namespace {

using testing::expect_file_error;
using testing::read_bytes;
using testing::TemporaryFolder;

/// Every write beyond `bytes` of a file fails, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : previous_handler_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &previous_);
    const rlimit limit{bytes, previous_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &previous_);
    signal(SIGXFSZ, previous_handler_);
  }

 private:
  void (*previous_handler_)(int);
  rlimit previous_{};
};

struct stat status_of(const std::filesystem::path& path) {
  struct stat status {};
  EXPECT_EQ(stat(path.c_str(), &status), 0) << path;
  return status;
}

void replace(const std::filesystem::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const TemporaryFolder folder;
  {
    AtomicFile file(folder / "a.txt");
    file.write("complete");
    EXPECT_FALSE(exists(folder / "a.txt"));
    file.commit();
    EXPECT_EQ(read_bytes(folder / "a.txt"), "complete");
  }
  EXPECT_EQ(folder.files(), 1u);
}

TEST(AtomicFile, WithoutCommitNothingChanges) {
  const TemporaryFolder folder;
  folder.write("a.txt", "before");
  {
    AtomicFile file(folder / "a.txt");
    file.write("half");
  }
  EXPECT_EQ(read_bytes(folder / "a.txt"), "before");
  EXPECT_EQ(folder.files(), 1u);
}

TEST(AtomicFile, TwoAtATimeDoNotMeet) {
  const TemporaryFolder folder;
  AtomicFile first(folder / "a.txt"), second(folder / "a.txt");
  first.write("first");
  second.write("second");
  second.commit();
  first.commit();
  EXPECT_EQ(read_bytes(folder / "a.txt"), "first");
  EXPECT_EQ(folder.files(), 1u);
}

TEST(AtomicFile, ASymbolicLinkStaysOne) {
  const TemporaryFolder folder;
  folder.write("real.txt", "before");
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  AtomicFile file(folder / "link.txt");
  file.write("after");
  file.commit();
  EXPECT_TRUE(is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_bytes(folder / "real.txt"), "after");
}

TEST(AtomicFile, ADanglingLinkIsWrittenThrough) {
  const TemporaryFolder folder;
  create_directory(folder / "elsewhere");
  std::filesystem::create_symlink("elsewhere/real.txt", folder / "first.txt");
  std::filesystem::create_symlink(folder / "first.txt", folder / "second.txt");
  replace(folder / "second.txt", "content");
  EXPECT_TRUE(is_symlink(folder / "first.txt") && is_symlink(folder / "second.txt"));
  EXPECT_EQ(read_bytes(folder / "elsewhere/real.txt"), "content");
  std::filesystem::create_symlink("circle.txt", folder / "circle.txt");
  expect_file_error([&] { replace(folder / "circle.txt", ""); }, {"circle.txt", "Too many levels of symbolic links"});
}

TEST(AtomicFile, PermissionsAndOwnerArePassedOn) {
  const TemporaryFolder folder;
  const mode_t umask_before = umask(022);
  replace(folder / "new.txt", "");
  EXPECT_EQ(status_of(folder / "new.txt").st_mode & 07777, 0644u);
  for (const mode_t mode : {0600, 0640, 0666, 0755}) {
    folder.write("a.txt", "before");
    ASSERT_EQ(chmod((folder / "a.txt").c_str(), mode), 0);
    replace(folder / "a.txt", "after");
    EXPECT_EQ(status_of(folder / "a.txt").st_mode & 07777, mode);
  }
  umask(umask_before);
  if (chown((folder / "a.txt").c_str(), 65534, 65534) != 0) GTEST_SKIP() << "only root can give a file away";
  replace(folder / "a.txt", "after");
  EXPECT_EQ(status_of(folder / "a.txt").st_uid, 65534u);
  EXPECT_EQ(status_of(folder / "a.txt").st_gid, 65534u);
  EXPECT_EQ(status_of(folder / "a.txt").st_mode & 07777, 0755u);
}

TEST(AtomicFile, NobodyElseReadsAPrivateFileWhileItIsWritten) {
  const TemporaryFolder folder;
  folder.write("a.txt", "secret");
  ASSERT_EQ(chmod((folder / "a.txt").c_str(), 0600), 0);
  AtomicFile file(folder / "a.txt");
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_EQ(status_of(entry.path()).st_mode & 0777, 0600u);
  }
}

TEST(AtomicFile, TheLongestNameIsNoneTooLong) {
  const TemporaryFolder folder;
  for (const std::size_t length : {248, 249, 255}) {
    const std::filesystem::path path = folder / (std::string(length - 4, 'n') + ".txt");
    replace(path, "content");
    EXPECT_EQ(read_bytes(path), "content");
  }
  expect_file_error([&] { replace(folder / std::string(256, 'n'), ""); }, {"File name too long"});
  EXPECT_EQ(folder.files(), 3u);
}

TEST(AtomicFile, UnwritablePlacesAreNamed) {
  const TemporaryFolder folder;
  folder.write("file", "");
  const auto create = [](const std::filesystem::path& path) { return [=] { AtomicFile file(path); }; };
  expect_file_error(create(folder / "none/a.ply"), {(folder / "none/a.ply").string(), "No such file or directory"});
  expect_file_error(create(folder / "file/a.ply"), {(folder / "file/a.ply").string(), "Not a directory"});
  expect_file_error(create(folder.path()), {folder.path().string(), "Is a directory"});
  expect_file_error(create("/proc/a.ply"), {"/proc/a.ply", "cannot create"});
  expect_file_error(create("/dev/null"), {"/dev/null", "not a regular file"});
  EXPECT_EQ(folder.files(), 1u);
}

TEST(AtomicFile, AFullDiskLeavesNothing) {
  const TemporaryFolder folder;
  folder.write("a.ply", "before");
  Points points;
  for (int i = 0; i < 10000; ++i) points.emplace_back(0.1 * i, std::sin(i), std::cos(i));
  for (const auto format : {FileFormat::ply_ascii, FileFormat::ply_binary_little_endian, FileFormat::pcd_binary,
                            FileFormat::pcd_binary_compressed, FileFormat::text}) {
    const FileSizeLimit full(4096);
    expect_file_error([&] { write_points(folder / "a.ply", points, {.format = format}); },
                      {(folder / "a.ply").string(), "cannot write", "File too large"});
  }
  // So few bytes wait in the buffer of the stream: the disk is found full only while closing.
  for (const auto format : {FileFormat::ply_ascii, FileFormat::pcd_binary}) {
    const FileSizeLimit full(10);
    expect_file_error(
        [&] {
          write_points(folder / "a.ply", {points.data(), 1}, {.format = format});
        },
        {(folder / "a.ply").string(), "cannot write", "File too large"});
  }
  {
    const FileSizeLimit full(10);
    expect_file_error([&] { write_transformation(folder / "T.txt", Transformation::Identity()); }, {"T.txt"});
  }
  EXPECT_EQ(read_bytes(folder / "a.ply"), "before");
  EXPECT_EQ(folder.files(), 1u);
}

TEST(AtomicFile, NoPointIsLostInSilence) {
  const TemporaryFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Points with_nan = {{1, 2, 3}, {4, nan, 6}}, large = {{1, 2, 1e300}};
  EXPECT_THROW(write_points(folder / "a.ply", with_nan), InvalidArgument);
  EXPECT_THROW(write_points(folder / "a.ply", large, {.format = {}, .single_precision = true}), InvalidArgument);
  EXPECT_EQ(folder.files(), 0u);
  EXPECT_NO_THROW(write_points(folder / "a.ply", large));
}

}  // namespace
}  // namespace igsp::io
