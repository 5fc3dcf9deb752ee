#include "config/option_list.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <vector>

#include "config/field_count.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

const Option& find(std::string_view key) {
  for (const Option& option : option_list()) {
    if (option.key == key) return option;
  }
  throw std::logic_error("no option " + std::string(key));
}

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

// An admissible value that differs from the current one.
OptionValue another_value(const Option& option, const Options& options) {
  const OptionValue now = option.get(options);
  switch (option.kind) {
    case OptionKind::boolean:
      return !std::get<bool>(now);
    case OptionKind::choice:
      return std::string(option.choices[0] == std::get<std::string>(now) ? option.choices[1] : option.choices[0]);
    case OptionKind::integer:
      for (const int value : {std::get<int>(now) + 1, std::get<int>(now) - 1, std::get<int>(now) - 2}) {
        if (contains(option.range, value)) return value;
      }
      break;
    case OptionKind::real:
      for (const double value : {std::get<double>(now) * 0.5, std::get<double>(now) + 0.125}) {
        if (value != std::get<double>(now) && contains(option.range, value)) return value;
      }
      break;
  }
  throw std::logic_error("no other value for " + std::string(option.key));
}

std::vector<OptionValue> all_values(const Options& options) {
  std::vector<OptionValue> values;
  for (const Option& option : option_list()) values.push_back(option.get(options));
  return values;
}

TEST(FieldCount, CountsFieldsOfNestedAggregates) {
  struct Inner {
    int a;
    double b;
  };
  struct Outer {
    bool first;
    Inner inner;
    Search last;
  };
  struct Empty {};
  EXPECT_EQ(field_count<Inner>(), 2u);
  EXPECT_EQ(field_count<Outer>(), 3u);
  EXPECT_EQ(field_count<Empty>(), 0u);
}

// With the static_assert beside the list (as many entries as fields) this shows that every field is reached, by
// exactly one entry: no entry moves another's value.
TEST(OptionList, EveryEntryReachesItsOwnField) {
  for (const Option& changed : option_list()) {
    Options options;
    const std::vector<OptionValue> before = all_values(options);
    const OptionValue value = another_value(changed, options);
    assign(options, changed, value);
    const std::vector<OptionValue> after = all_values(options);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const bool is_changed = &option_list()[i] == &changed;
      EXPECT_EQ(after[i], is_changed ? value : before[i]) << changed.key << " against " << option_list()[i].key;
    }
  }
}

TEST(OptionList, KeysAndFlagsAreUniqueAndDescribed) {
  std::set<std::string_view> keys, flags;
  for (const Option& option : option_list()) {
    EXPECT_TRUE(keys.insert(option.key).second) << option.key;
    EXPECT_TRUE(flags.insert(option.flag).second) << option.flag;
    EXPECT_TRUE(option.flag.starts_with("--")) << option.key;
    EXPECT_FALSE(option.help.empty()) << option.key;
  }
}

TEST(OptionList, KeyIsThePathOfTheField) {
  Options options;
  options.keypoints.pca_radius = 12.5;
  options.search = Search::direct;
  EXPECT_EQ(find("keypoints.pca_radius").get(options), OptionValue(12.5));
  EXPECT_EQ(find("search").get(options), OptionValue(std::string("direct")));
  EXPECT_EQ(name_in_section(find("keypoints.pca_radius")), "pca_radius");
  EXPECT_EQ(name_in_section(find("search")), "search");
}

TEST(Range, OpenAndClosedEnds) {
  const Range half_open{0.0, 1.0, true, false};
  EXPECT_FALSE(contains(half_open, 0.0));
  EXPECT_TRUE(contains(half_open, 1.0));
  EXPECT_FALSE(contains(half_open, 1.0000001));
  EXPECT_EQ(to_string(half_open), "in (0, 1]");
  const Range four_or_six{4, 6, false, false, Range::Shape::ends_only};
  EXPECT_TRUE(contains(four_or_six, 4));
  EXPECT_FALSE(contains(four_or_six, 5));
  EXPECT_EQ(to_string(four_or_six), "4 or 6");
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(contains(Range{0.0, infinity}, infinity));
  EXPECT_FALSE(contains(Range{-infinity, infinity}, std::nan("")));
  EXPECT_EQ(to_string(Range{0.0, infinity, true}), "greater than 0");
}

TEST(Validate, DefaultsAndPresetsAreAdmissible) {
  EXPECT_NO_THROW(validate(Options{}));
  EXPECT_NO_THROW(validate(preset("default")));
  EXPECT_NO_THROW(validate(preset("paper")));
}

TEST(Validate, NamesOptionValueAndRange) {
  Options options;
  options.keypoints.max_eigenvalue_ratio = 1.5;
  EXPECT_EQ(message_of([&] { validate(options); }),
            "option keypoints.max_eigenvalue_ratio (--max-eigenvalue-ratio) is 1.5; it must be in (0, 1]");
  options = {};
  options.degrees_of_freedom = 5;
  EXPECT_EQ(message_of([&] { validate(options); }), "option degrees_of_freedom (--dof) is 5; it must be 4 or 6");
  options = {};
  options.search = static_cast<Search>(7);
  EXPECT_EQ(message_of([&] { validate(options); }),
            "option search (--search) is 7; it must be one of direct, hypotheses");
  options = {};
  options.keypoints.pca_radius = std::nan("");
  EXPECT_THROW(validate(options), InvalidArgument);
}

TEST(Validate, RefusesEveryRealOptionThatIsNotFinite) {
  for (const Option& option : option_list()) {
    if (option.kind != OptionKind::real) continue;
    for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      Options options;
      option.set(options, value);
      EXPECT_THROW(validate(options), InvalidArgument) << option.key;
    }
  }
}

TEST(UnusualValues, NameTheOptionAndWhatIsUsual) {
  for (const std::string_view name : {"default", "paper"}) EXPECT_TRUE(unusual_values(preset(name)).empty()) << name;
  Options options;
  options.descriptor.radius = 100;
  EXPECT_EQ(unusual_values(options), std::vector<std::string>{"--descriptor-radius is 100.0 [voxels]: pairs are lost "
                                                              "that way; usual is in [4, 30], the default 7.0"});
  options = {};
  options.keypoints.pca_radius = 100;
  options.scale.target_points = 100;
  EXPECT_EQ(unusual_values(options).size(), 2u);
  options.scale.target_points = 1'000'000;
  options.keypoints.pca_radius = 3;
  EXPECT_TRUE(unusual_values(options).empty());
}

TEST(UnusualValues, AreAdmissible) {
  for (const Option& option : option_list()) {
    for (const double end : {option.usual.low, option.usual.high}) {
      if (std::isfinite(end)) EXPECT_TRUE(contains(option.range, end)) << option.key;
    }
  }
}

TEST(AssignText, ReadsEveryKind) {
  Options options;
  assign_text(options, find("keypoints.pca_radius"), "9.5");
  assign_text(options, find("threads"), "3");
  assign_text(options, find("refinement.enabled"), "false");
  assign_text(options, find("energy.threshold_rule"), "released");
  EXPECT_EQ(options.keypoints.pca_radius, 9.5);
  EXPECT_EQ(options.threads, 3);
  EXPECT_FALSE(options.refinement.enabled);
  EXPECT_EQ(options.energy.threshold_rule, ThresholdRule::released);
}

TEST(AssignText, RefusesWhatIsNotTheWholeValue) {
  Options options;
  for (const char* text : {"", "3.5", "3x", " 3", "99999999999", "true"}) {
    EXPECT_THROW(assign_text(options, find("threads"), text), InvalidArgument) << text;
  }
  for (const char* text : {"", "abc", "1,5", "6.0 ", "nan", "inf", "1e999"}) {
    EXPECT_THROW(assign_text(options, find("keypoints.pca_radius"), text), InvalidArgument) << text;
  }
  EXPECT_EQ(message_of([&] { assign_text(options, find("threads"), "two"); }),
            "option threads (--threads) takes an integer, not \"two\"");
}

TEST(Assign, TakesAnIntegerForARealOptionOnly) {
  Options options;
  assign(options, find("keypoints.pca_radius"), 5);
  EXPECT_EQ(options.keypoints.pca_radius, 5.0);
  EXPECT_THROW(assign(options, find("threads"), 2.0), InvalidArgument);
  EXPECT_THROW(assign(options, find("threads"), std::string("2")), InvalidArgument);
  EXPECT_THROW(assign(options, find("search"), 1), InvalidArgument);
}

TEST(OptionValueText, ReadsBackTheSameNumber) {
  EXPECT_EQ(to_string(OptionValue(6.0)), "6.0");
  EXPECT_EQ(to_string(OptionValue(6)), "6");
  EXPECT_TRUE(rc::check([](double value) {
    Options options;
    const double positive = std::abs(value) + 1e-6;
    assign_text(options, find("scale.voxel_size"), to_string(OptionValue(positive)));
    RC_ASSERT(options.scale.voxel_size == positive);
  }));
}

TEST(Preset, PaperIsTable1AndItsAlgorithmAlone) {
  const Options paper = preset("paper");
  EXPECT_EQ(paper.search, Search::direct);
  EXPECT_FALSE(paper.refinement.enabled);
  EXPECT_EQ(paper.energy.distance_scale, 30.0);
  EXPECT_EQ(paper.energy.weight_changing_rate, 8.0);
  EXPECT_EQ(paper.energy.p1, 2.5);
  EXPECT_EQ(paper.energy.p2, 1.5);
  EXPECT_EQ(paper.energy.p3, 1.25);
  EXPECT_EQ(paper.keypoints.suppression_radius, 4.0);
  EXPECT_EQ(paper.descriptor.radius, 10.0);
}

TEST(Preset, UnknownNameIsAnErrorThatNamesTheNearest) {
  const std::string message = message_of([] { preset("papre"); });
  EXPECT_NE(message.find("\"papre\""), std::string::npos) << message;
  EXPECT_NE(message.find("did you mean \"paper\""), std::string::npos) << message;
}

}  // namespace
}  // namespace igsp
