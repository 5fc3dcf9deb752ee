#include <gtest/gtest.h>

#include <filesystem>

#include "io/io_testing.hpp"

namespace igsp::io {
namespace {

const auto corpus = std::filesystem::path(IGSP_CORPUS);

/// What the fuzzer has found and what it starts from: all of it is read or refused with a FileError, as PLY, PCD or LAS
/// (by content) and as text.
TEST(Corpus, EveryFileIsReadOrRefused) {
  const testing::TemporaryFolder folder;
  std::size_t files = 0, read = 0, refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
    ++files;
    for (const auto name : {"input.ply", "input.pcd", "input.txt"}) {
      SCOPED_TRACE(entry.path().filename().string() + " as " + name);
      copy_file(entry.path(), folder / name, std::filesystem::copy_options::overwrite_existing);
      try {
        for (const auto& point : read_points(folder / name).points) ASSERT_TRUE(point.allFinite());
        ++read;
      } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find((folder / name).string()), std::string::npos) << error.what();
        ++refused;
      }
    }
    EXPECT_NO_FATAL_FAILURE(try { read_transformation(entry.path()); } catch (const FileError&){});
  }
  EXPECT_GE(files, 20u);
  EXPECT_GE(read, files / 2) << "most seeds are good files";
  EXPECT_GE(refused, 1u);
}

}  // namespace
}  // namespace igsp::io
