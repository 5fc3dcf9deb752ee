// LAS as rows of numbers, for igsp convert.

#include <gtest/gtest.h>

#include <map>

#include "io/las_testing.hpp"
#include "io/moved_copy.hpp"
#include "io/rows.hpp"

namespace igsp::io {
namespace {

using testing::bytes_of;
using testing::las_of_format;
using testing::LasFile;
using testing::TemporaryFolder;

/// The values of the first point by their names.
std::map<std::string, double> values_of(const LasFile& las, const std::string& record) {
  const TemporaryFolder folder;
  std::string bytes = las.bytes();
  bytes.replace(las.points_start(), record.size(), record);
  InputFile file(folder.write("a.las", bytes));
  RowSource rows = open_rows(file, {});
  std::vector<double> row(rows.fields.size());
  EXPECT_TRUE(rows.next(row));
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < row.size(); ++i) values[rows.fields[i].name] = row[i];
  EXPECT_EQ(values.size(), row.size()) << "no name twice";
  return values;
}

const std::string origin(12, '\0');

TEST(LasRows, OldPointFormat) {
  const std::string record = origin + bytes_of(std::uint16_t{700}) + "\xD5\x62" + bytes_of(std::int8_t{-9}) + "\x21" +
                             bytes_of(std::uint16_t{40000}) + bytes_of(12.5) + bytes_of(std::uint16_t{1}) +
                             bytes_of(std::uint16_t{2}) + bytes_of(std::uint16_t{65535});
  LasFile las = las_of_format(3);
  las.extra.clear();
  const auto values = values_of(las, record);
  const std::map<std::string, double> expected = {{"x", 500000},
                                                  {"y", 5000000},
                                                  {"z", 100},
                                                  {"intensity", 700},
                                                  {"return_number", 5},
                                                  {"number_of_returns", 2},
                                                  {"classification", 2},
                                                  {"scan_direction_flag", 1},
                                                  {"edge_of_flight_line", 1},
                                                  {"synthetic", 1},
                                                  {"key_point", 1},
                                                  {"withheld", 0},
                                                  {"user_data", 33},
                                                  {"scan_angle_rank", -9},
                                                  {"point_source_id", 40000},
                                                  {"gps_time", 12.5},
                                                  {"red", 1},
                                                  {"green", 2},
                                                  {"blue", 65535}};
  EXPECT_EQ(values, expected);
}

TEST(LasRows, NewPointFormatWithWaveformAndExtraBytes) {
  const auto described = [](char type, const std::string& name) {
    std::string descriptor = std::string(2, '\0') + type + '\0' + name;
    descriptor.resize(192);
    return descriptor;
  };
  LasFile las = las_of_format(10);
  las.extra = bytes_of(0.5f) + bytes_of(std::int16_t{-3}) + bytes_of(std::int16_t{4}) + "undescribed";
  las.records = testing::las_record("LASF_Spec", 4, described(9, "deviation") + described(14, "rings"));
  const std::string record =
      origin + bytes_of(std::uint16_t{700}) + "\x4B\xA9\x06\x21" + bytes_of(std::int16_t{-2000}) +
      bytes_of(std::uint16_t{40000}) + bytes_of(12.5) + bytes_of(std::uint16_t{1}) + bytes_of(std::uint16_t{2}) +
      bytes_of(std::uint16_t{3}) + bytes_of(std::uint16_t{4}) + "\x05" + bytes_of(std::uint64_t{6}) +
      bytes_of(std::uint32_t{7}) + bytes_of(8.5f) + bytes_of(1.5f) + bytes_of(2.5f) + bytes_of(3.5f);
  auto values = values_of(las, record);
  const std::map<std::string, double> expected = {{"x", 500000},
                                                  {"y", 5000000},
                                                  {"z", 100},
                                                  {"intensity", 700},
                                                  {"return_number", 11},
                                                  {"number_of_returns", 4},
                                                  {"synthetic", 1},
                                                  {"key_point", 0},
                                                  {"withheld", 0},
                                                  {"overlap", 1},
                                                  {"scanner_channel", 2},
                                                  {"scan_direction_flag", 0},
                                                  {"edge_of_flight_line", 1},
                                                  {"classification", 6},
                                                  {"user_data", 33},
                                                  {"scan_angle", -2000},
                                                  {"point_source_id", 40000},
                                                  {"gps_time", 12.5},
                                                  {"red", 1},
                                                  {"green", 2},
                                                  {"blue", 3},
                                                  {"nir", 4},
                                                  {"wavepacket_index", 5},
                                                  {"wavepacket_offset", 6},
                                                  {"wavepacket_size", 7},
                                                  {"return_point_wave_location", 8.5},
                                                  {"x_t", 1.5},
                                                  {"y_t", 2.5},
                                                  {"z_t", 3.5},
                                                  {"deviation", 0.5},
                                                  {"rings_0", -3},
                                                  {"rings_1", 4}};
  EXPECT_EQ(values, expected);
}

TEST(LasRows, DescriptionsThatDoNotFitAreLeftOut) {
  for (const char type : {'\x0A', '\x1E', '\x1F', '\xFF'}) {
    LasFile las = las_of_format(0);
    las.extra = "four";
    std::string descriptor = std::string(2, '\0') + type + '\0' + std::string(32, 'n');
    descriptor.resize(192);
    las.records = testing::las_record("LASF_Spec", 4, descriptor + descriptor + "cut");
    EXPECT_EQ(values_of(las, origin).size(), 15u);
  }
}

TEST(LasRows, NoiseIsLeftOut) {
  LasFile las = las_of_format(7);
  las.noise = {0, 99};
  const TemporaryFolder folder;
  const auto path = folder.write("a.las", las.bytes());
  for (const bool keep : {false, true}) {
    InputFile file(path);
    ReadOptions options;
    options.keep_noise = keep;
    RowSource rows = open_rows(file, options);
    std::vector<double> row(rows.fields.size());
    int count = 0;
    while (rows.next(row)) ++count;
    EXPECT_EQ(count, keep ? 100 : 98);
  }
  EXPECT_EQ(other_properties(path).size(), 18u);
}

}  // namespace
}  // namespace igsp::io
