// PLY as rows of numbers, for igsp convert.

#include <gtest/gtest.h>

#include "igsp/errors.hpp"
#include "io/io_testing.hpp"
#include "io/rows.hpp"

namespace igsp::io {
namespace {

using testing::bytes_of;
using testing::TemporaryFolder;

const std::string one_vertex = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";

std::string ply_of(const std::string& format, const std::string& elements, const std::string& body) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + body;
}

std::vector<double> first_row(const std::string& content) {
  const TemporaryFolder folder;
  InputFile file(folder.write("a.ply", content));
  RowSource rows = open_rows(file, {});
  std::vector<double> row(rows.fields.size());
  EXPECT_TRUE(rows.next(row));
  return row;
}

TEST(PlyRows, ElementsBeforeTheVerticesArePassedOver) {
  const std::vector<double> expected = {1, 2, 3};
  const std::string face = "element face 2\nproperty list uchar ushort i\nproperty uchar c\n";
  EXPECT_EQ(first_row(ply_of("ascii", face + one_vertex, "3 7 8 9 1\n0 2\n1 2 3\n")), expected);
  const std::string faces =
      bytes_of(std::uint8_t{1}) + bytes_of(std::uint16_t{7}) + "c" + bytes_of(std::uint8_t{0}) + "d";
  const std::string vertex = bytes_of(1.0f) + bytes_of(2.0f) + bytes_of(3.0f);
  EXPECT_EQ(first_row(ply_of("binary_little_endian", face + one_vertex, faces + vertex)), expected);
}

TEST(PlyRows, AnElementBeforeThemThatIsCutOffIsNamed) {
  const std::string face = "element face 3\nproperty uchar c\n";
  EXPECT_THROW(first_row(ply_of("ascii", face + one_vertex, "1\n2\n")), FileError);
  EXPECT_THROW(first_row(ply_of("binary_little_endian", face + one_vertex, "ab")), FileError);
}

TEST(PlyRows, AListLongerThanBytesCanBeCountedIsRefused) {
  const std::string face = "element face 1\nproperty list uint64 double i\n";
  EXPECT_THROW(first_row(ply_of("binary_little_endian", face + one_vertex, std::string(20, '\xFF'))), FileError);
  const std::string small = "element face 1\nproperty list char uchar i\n";
  EXPECT_THROW(first_row(ply_of("binary_little_endian", small + one_vertex, std::string(13, '\xFF'))), FileError);
}

}  // namespace
}  // namespace igsp::io
