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
    EXPECT_EQ(folder.files(), 2u);
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
