#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "igsp/options.hpp"

namespace igsp {

/// Admissible values of a numeric option. A limit may be infinite; a value never is.
struct Range {
  enum class Shape { interval, ends_only };
  double low;
  double high;
  bool low_open = false;
  bool high_open = false;
  Shape shape = Shape::interval;
};

/// "in (0, 1]", "greater than 0", "4 or 6"; empty if everything is admissible.
std::string to_string(const Range& range);
bool contains(const Range& range, double value);

/// The value of an option outside of Options; an enumerator travels by its name.
using OptionValue = std::variant<bool, int, double, std::string>;

/// Shortest text that reads back as the same value; a real number always shows that it is one ("6.0").
std::string to_string(const OptionValue& value);

enum class OptionKind { boolean, integer, real, choice };

/// Everything known of one field of Options.
struct Option {
  std::string_view key;      ///< "keypoints.pca_radius": path of the field, and its name in TOML and JSON
  std::string_view section;  ///< "keypoints"; empty at the top level
  std::string_view flag;     ///< "--pca-radius"
  std::string_view unit;     ///< empty: a pure number
  Range range;               ///< integer and real only
  Range usual;               ///< within the range; values outside of it are known to lose pairs
  std::string_view help;
  OptionKind kind;
  std::span<const std::string_view> choices;  ///< choice only
  OptionValue (*get)(const Options&);
  void (*set)(Options&, const OptionValue&);  ///< the value must hold the alternative of `kind`
};

/// THE list of options, in the order of the fields. Validation, command line, TOML, JSON and help come from it.
std::span<const Option> option_list();

/// "keypoints.pca_radius" without its section: "pca_radius".
std::string_view name_in_section(const Option& option);

/// "greater than 0" or "one of direct, hypotheses".
std::string admissible_values(const Option& option);

/// "in (0, 100]; usual: in [4, 30]": the admissible values and, where they are fewer, the usual ones.
std::string values_in_words(const Option& option);

/// A warning for every value that is admissible and not usual, with what is.
std::vector<std::string> unusual_values(const Options& options);

/// Throws InvalidArgument that names the option, the value and what is admissible.
void check(const Option& option, const OptionValue& value);

/// Checks and stores a value; an integer is welcome where a real number is expected. Throws InvalidArgument.
void assign(Options& options, const Option& option, const OptionValue& value);

/// The same from a command line's text. Throws InvalidArgument.
void assign_text(Options& options, const Option& option, std::string_view text);

}  // namespace igsp
