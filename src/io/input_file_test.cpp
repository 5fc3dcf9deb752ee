#include "io/input_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "io/io_testing.hpp"

namespace igsp::io {
namespace {

using testing::expect_file_error;
using testing::expect_unreadable;
using testing::TemporaryFolder;

TEST(InputFile, WhatIsNoFileSaysSo) {
  const TemporaryFolder folder;
  for (const auto name : {"none.ply", "none.pcd", "none.xyz", "none"}) {
    expect_file_error([&] { read_points(folder / name); }, {(folder / name).string(), "no such file"});
  }
  std::filesystem::create_directory(folder / "folder.ply");
  expect_file_error([&] { read_points(folder / "folder.ply"); }, {(folder / "folder.ply").string(), "directory"});
  ASSERT_EQ(mkfifo((folder / "pipe.ply").c_str(), 0600), 0);
  expect_file_error([&] { read_points(folder / "pipe.ply"); }, {"pipe.ply", "not a regular file"});
  folder.write("file", "1 2 3\n");
  expect_file_error([&] { read_points(folder / "file/a.ply"); }, {"file/a.ply"});
}

TEST(InputFile, AnEmptyFileIsAnError) {
  for (const auto name : {"a.ply", "a.pcd", "a.xyz", "a.csv", "a"}) expect_unreadable(name, "", {"empty"});
}

TEST(InputFile, AnUnknownExtensionIsAnErrorUnlessTheContentTells) {
  expect_unreadable("a.e57", "LAS", {"a.e57", "unknown kind of file"});
  expect_unreadable("a", "1 2 3\n", {"unknown kind of file"});
}

TEST(InputFile, AReaderWithoutChunksIsTheCallersMistake) {
  const TemporaryFolder folder;
  EXPECT_THROW(PointReader(folder.write("a.xyz", "1 2 3\n"), 0), InvalidArgument);
}

TEST(InputFile, LinesAcrossTheBufferKeepTheirNumberAndContent) {
  const TemporaryFolder folder;
  std::string content;
  const std::string longest(InputFile::buffer_size - 1, 'b');
  for (int i = 0; i < 5; ++i) content += std::string(700'000, static_cast<char>('a' + i)) + "\r\n";
  InputFile file(folder.write("a", content + longest + "\nlast"));
  std::string_view line;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(file.read_line(line));
    EXPECT_EQ(line, std::string(700'000, static_cast<char>('a' + i)));
    EXPECT_EQ(file.line(), static_cast<std::uint64_t>(i + 1));
  }
  EXPECT_EQ(file.offset(), content.size());
  ASSERT_TRUE(file.read_line(line));
  EXPECT_EQ(line, longest);
  ASSERT_TRUE(file.read_line(line));
  EXPECT_EQ(line, "last");
  EXPECT_FALSE(file.read_line(line));
}

TEST(InputFile, SkippingBytesAndLines) {
  const TemporaryFolder folder;
  const std::string long_line(3 * InputFile::buffer_size, 'x');
  InputFile file(folder.write("a", long_line + "\nsecond\nthird"));
  ASSERT_TRUE(file.skip_line());
  EXPECT_EQ(file.offset(), long_line.size() + 1);
  std::string_view line;
  ASSERT_TRUE(file.read_line(line));
  EXPECT_EQ(line, "second");
  file.unread_line();
  ASSERT_TRUE(file.read_line(line));
  EXPECT_EQ(line, "second");
  EXPECT_EQ(file.line(), 2u);
  EXPECT_EQ(file.read(2), "th");
  file.skip(3);
  EXPECT_FALSE(file.skip_line());

  InputFile again(folder / "a");
  again.skip(long_line.size() + 1);
  EXPECT_EQ(again.read(6), "second");
  expect_file_error([&] { again.read(7); }, {"byte offset " + std::to_string(again.size()), "truncated"});
  expect_file_error([&] { again.skip(7); }, {"byte offset " + std::to_string(again.size()), "truncated"});
}

}  // namespace
}  // namespace igsp::io
