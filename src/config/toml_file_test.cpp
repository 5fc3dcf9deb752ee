#include "config/toml_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/option_list.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

void expect_same(const Options& a, const Options& b) {
  for (const Option& option : option_list()) EXPECT_EQ(option.get(a), option.get(b)) << option.key;
}

template <typename Error>
std::string message_of(std::string_view toml) {
  try {
    options_from_toml(toml, "igsp.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Toml, PresetsReadBackAsTheyWereWritten) {
  expect_same(options_from_toml(options_to_toml(preset("paper")), "text"), preset("paper"));
  expect_same(options_from_toml(options_to_toml(preset("default")), "text"), preset("default"));
}

TEST(Toml, WhatTheFuzzerHasFoundIsReadOrRefused) {
  std::size_t read = 0, refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(IGSP_CORPUS)) {
    try {
      const std::string text = options_to_toml(read_options(entry.path()));
      EXPECT_EQ(options_to_toml(options_from_toml(text, "printed")), text) << entry.path();
      ++read;
    } catch (const FileError&) {
      ++refused;
    } catch (const InvalidArgument&) {
      ++refused;
    }
  }
  EXPECT_GE(read, 1u);
  EXPECT_GE(refused, 10u);
}

// The parser itself ends the program on most of these.
TEST(Toml, OnlyLinesThatTheParserSurvivesReachIt) {
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "a.";
  struct Refusal {
    std::string text;
    std::string_view fault;
  };
  constexpr std::string_view long_name = "1: a name of more than 200 letters", neither = "1: neither [section] nor",
                             single = "1: an option takes a single value", more = "1: more than one section or value";
  for (const auto& [text, fault] : std::vector<Refusal>{
           {"[" + deep + "a]", long_name},
           {deep + "a = 1", long_name},
           {"[.a]", neither},
           {"[[a]]", neither},
           {"[ = ]", neither},
           {"[", neither},
           {"[#]\n", neither},
           {"[\r\n]", neither},
           {"[a..b]", neither},
           {"\xEF\xBB\xBF[.a]", neither},
           {"[\xc3\xa4]", neither},
           {"\xef\xba\xbf# a", neither},
           {"a\n= 1", neither},
           {"'='=[[}", neither},
           {"preset = [}", single},
           {"a = {b = [}}", single},
           {"threads = [\n1]", single},
           {"threads = 2020-01-01", single},
           {"threads = 1970-01-01 7 ", single},
           {"e=7700-11-11t=0z:.-T<-10-11\nsss", single},
           {"threads = 07:32:00", more},
           {"threads = 7----&---= 7 -", single},
           {"threads = 5\"\xef\xba\xbf", more},
           {"preset = \"\xc3\xa4\"", single},
           {"preset = \"a\\\"b\"", single},
           {"preset = \"\"\"\npaper\"\"\"", more},
           {"threads = 1\rthreads", more},
           {"threads = 1 search = 'direct'", more},
       }) {
    EXPECT_NE(message_of<FileError>(text).find(fmt::format("igsp.toml:{}", fault)), std::string::npos)
        << text.substr(0, 100) << ": " << message_of<FileError>(text);
  }
}

TEST(Toml, CommentsAndBlanksMayStandAnywhere) {
  const Options options = options_from_toml(
      "\xEF\xBB\xBF# z\xc3\xa4hlt [.a]\r\n\r\nthreads =\t2\t # [2]\r\n  search= 'direct' #\n[ energy ]# =\np1=+2e-1",
      "a.toml");
  EXPECT_EQ(options.threads, 2);
  EXPECT_EQ(options.search, Search::direct);
  EXPECT_EQ(options.energy.p1, 0.2);
  EXPECT_NO_THROW(options_from_toml("# " + std::string(400000, '.') + "\nthreads = 1\n", "text"));
}

TEST(Toml, AnyRealValuesReadBackExactly) {
  EXPECT_TRUE(rc::check([] {
    Options options;
    for (const Option& option : option_list()) {
      if (option.kind != OptionKind::real) continue;
      const double high = std::min(option.range.high, 1e9);
      const double share = *rc::gen::inRange(1, 1000000) / 1000001.0;
      option.set(options, option.range.low + (high - option.range.low) * share * share * share);
    }
    validate(options);
    const Options back = options_from_toml(options_to_toml(options), "text");
    for (const Option& option : option_list()) RC_ASSERT(option.get(options) == option.get(back));
  }));
}

TEST(Toml, WrittenTextNamesEveryOptionWithItsHelpAndRange) {
  const std::string text = options_to_toml(Options{});
  for (const Option& option : option_list()) {
    EXPECT_NE(text.find(std::string(option.help)), std::string::npos) << option.key;
    EXPECT_NE(text.find(std::string(name_in_section(option)) + " = "), std::string::npos) << option.key;
  }
  EXPECT_NE(text.find("[keypoints]"), std::string::npos);
  EXPECT_NE(text.find("in (0, 1]"), std::string::npos);
}

TEST(Toml, EmptyTextIsTheDefault) {
  expect_same(options_from_toml("", "text"), Options{});
}

TEST(Toml, WhatIsLeftOutComesFromTheNamedPreset) {
  const Options options = options_from_toml("preset = \"paper\"\n[descriptor]\nradius = 8\n", "text");
  Options expected = preset("paper");
  expected.descriptor.radius = 8.0;
  expect_same(options, expected);
}

TEST(Toml, DottedKeysAreSections) {
  EXPECT_EQ(options_from_toml("keypoints.pca_radius = 9\n", "text").keypoints.pca_radius, 9.0);
}

TEST(Toml, UnknownKeyNamesLineAndNearest) {
  EXPECT_EQ(message_of<InvalidArgument>("threads = 1\n\n[keypoints]\npca_raduis = 6.0\n"),
            "igsp.toml:4:1: unknown option \"keypoints.pca_raduis\"; did you mean \"keypoints.pca_radius\"?");
  EXPECT_EQ(message_of<InvalidArgument>("[keypoint]\npca_radius = 6.0\n"),
            "igsp.toml:1:2: unknown option \"keypoint\"; did you mean \"keypoints\"?");
}

TEST(Toml, ValueOutOfRangeNamesLineValueAndRange) {
  EXPECT_EQ(message_of<InvalidArgument>("[keypoints]\npca_radius = -1\n"),
            "igsp.toml:2:1: option keypoints.pca_radius (--pca-radius) is -1.0; it must be in (0, 100] [voxels]");
  EXPECT_EQ(message_of<InvalidArgument>("threads = 99999999999\n"),
            "igsp.toml:1:1: option threads is 99999999999; it must be in [0, 1024]");
}

TEST(Toml, WrongKindOfValueIsAnError) {
  for (const char* text :
       {"threads = 1.5", "threads = \"1\"", "search = 1", "search = \"drect\"", "keypoints = 3", "preset = 1",
        "preset = \"papr\"", "refinement.enabled = 1", "keypoints.pca_radius = nan", "[search]\na = 1"}) {
    EXPECT_NE(message_of<InvalidArgument>(text).find("igsp.toml:1:"), std::string::npos) << text;
  }
}

TEST(Toml, WhatIsNotTomlIsAFileErrorWithItsLine) {
  EXPECT_NE(message_of<FileError>("threads = 1\nsearch =\n").find("igsp.toml:2:"), std::string::npos);
  EXPECT_NE(message_of<FileError>("threads = 1\nthreads = 2\n").find("igsp.toml:2:"), std::string::npos);
}

TEST(Toml, UnreadableFileIsAFileErrorWithItsPath) {
  EXPECT_THROW(read_options("/nowhere/igsp.toml"), FileError);
  EXPECT_THROW(read_options("/"), FileError);
}

}  // namespace
}  // namespace igsp
